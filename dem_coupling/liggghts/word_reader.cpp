// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/liggghts/word_reader.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>

namespace him {

std::string WordReader::word(const std::string& after)
{
    if (done()) {
        throw std::invalid_argument("something is missing after '" + after + "'");
    }
    return words_[next_++];
}

double WordReader::number(const std::string& after)
{
    const std::string text = word(after);
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0' || !std::isfinite(value)) {
        complaints_.add(after, "found '" + text + "', but a finite number is expected");
        return std::nan("");
    }
    return value;
}

double WordReader::positive(const std::string& after, const std::string& unit)
{
    const double value = number(after);
    if (std::islessequal(value, 0)) {
        complaints_.add(after, "found " + last() + ", but a number above zero is expected " + unit);
    }
    return value;
}

int WordReader::whole(const std::string& after)
{
    const std::string text = word(after);
    char* end = nullptr;
    const long value = std::strtol(text.c_str(), &end, 10);
    if (text.empty() || *end != '\0' || std::labs(value) > std::numeric_limits<int>::max()) {
        complaints_.add(after, "found '" + text + "', but a whole number is expected");
        return 0;
    }
    return static_cast<int>(value);
}

std::uint64_t WordReader::seed(const std::string& after)
{
    const int value = whole(after);
    if (value < 0) {
        complaints_.add(after, "found " + last() + ", but a seed is a whole number >= 0");
    }
    return static_cast<std::uint64_t>(value);
}

int WordReader::oneOf(const std::string& after, const std::array<const char*, 2>& known)
{
    const std::string text = word(after);
    for (int n = 0; n < 2; ++n) {
        if (text == known[static_cast<std::size_t>(n)]) {
            return n;
        }
    }
    complaints_.add(after, "unknown word '" + text + "'; known: " + known[0] + ", " + known[1]);
    return 0;
}

void WordReader::expect(const char* keyword, const std::string& after)
{
    const std::string found = word(after);
    if (found != keyword) {
        throw std::invalid_argument("expected '" + std::string(keyword) + "' after '" + after + "', found '" + found + "'");
    }
}

}  // namespace him
