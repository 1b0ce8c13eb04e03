// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem_coupling/complaints.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace him {

/// Takes the words of a script line one after the other. A missing word ends the reading (std::invalid_argument), everything
/// else is collected in the complaints.
class WordReader {
public:
    WordReader(const std::vector<std::string>& words, Complaints& complaints) : words_(words), complaints_(complaints) {}

    bool done() const { return next_ == words_.size(); }
    const std::string& last() const { return words_[next_ - 1]; }

    /// @param after  what stands before the word, for messages
    std::string word(const std::string& after);
    /// A finite number, or a complaint and NaN.
    double number(const std::string& after);
    /// A number above zero; otherwise a complaint.
    double positive(const std::string& after, const std::string& unit);
    /// A whole number; otherwise a complaint and 0.
    int whole(const std::string& after);
    std::uint64_t seed(const std::string& after);
    /// 0 for the first word of `known`, 1 for the second.
    int oneOf(const std::string& after, const std::array<const char*, 2>& known);
    /// Throws std::invalid_argument unless the next word is this one.
    void expect(const char* keyword, const std::string& after);

private:
    const std::vector<std::string>& words_;
    Complaints& complaints_;
    std::size_t next_ = 0;
};

}  // namespace him
