// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdio>
#include <functional>
#include <string>

namespace him {

/// The stream that LIGGGHTS prints to. While the script is read all of it reaches stdout, at once; afterwards only errors
/// and warnings do, because a host that runs LIGGGHTS in short intervals would drown in thermo headers.
class LiggghtsScreen {
public:
    LiggghtsScreen();
    LiggghtsScreen(const LiggghtsScreen&) = delete;
    LiggghtsScreen& operator=(const LiggghtsScreen&) = delete;

    /// Owned by LIGGGHTS once handed over: it closes its screen itself.
    std::FILE* stream() const { return stream_; }
    void quiet() { quiet_ = true; }
    /// What gives the script line that is being carried out, for errors while the script is read.
    void setScriptLine(std::function<std::string()> scriptLine) { scriptLine_ = std::move(scriptLine); }
    void write(const char* text, std::size_t size);

private:
    void writeLine(const std::string& line) const;

    std::FILE* stream_;
    std::string line_;
    std::function<std::string()> scriptLine_;
    bool quiet_ = false;
};

}  // namespace him
