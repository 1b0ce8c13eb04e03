// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sstream>
#include <string>
#include <vector>

namespace him {

/// A number as a person would write it, with up to `digits` digits.
inline std::string shown(double value, int digits = 6)
{
    std::ostringstream stream;
    stream.precision(digits);
    stream << value;
    return stream.str();
}

/// The words of a text, which spaces and line ends part.
inline std::vector<std::string> wordsOf(const std::string& text)
{
    std::istringstream stream(text);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) {
        words.push_back(word);
    }
    return words;
}

}  // namespace him
