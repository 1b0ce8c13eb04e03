// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace him {

/// Everything that is wrong with a case, collected so that the user sees all of it at once. One complaint says where
/// (file and entry), what was found, what is allowed and what to do.
class Complaints {
public:
    void add(const std::string& where, const std::string& what) { lines_.push_back(where + ": " + what); }
    void add(const Complaints& others) { lines_.insert(lines_.end(), others.lines_.begin(), others.lines_.end()); }
    bool none() const { return lines_.empty(); }
    const std::vector<std::string>& lines() const { return lines_; }

    /// Numbered list, one complaint a paragraph.
    std::string text() const
    {
        std::string all;
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            all += "  " + std::to_string(i + 1) + ". " + lines_[i] + "\n";
        }
        return all;
    }

private:
    std::vector<std::string> lines_;
};

}  // namespace him
