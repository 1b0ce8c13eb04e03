// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/liggghts/liggghts_screen.hpp"

#include "dem_coupling/liggghts/contact_models.hpp"

#include <stdexcept>

namespace him {
namespace {

ssize_t writeToScreen(void* screen, const char* text, std::size_t size)
{
    static_cast<LiggghtsScreen*>(screen)->write(text, size);
    return static_cast<ssize_t>(size);
}

bool holds(const std::string& line, const char* text)
{
    return line.find(text) != std::string::npos;
}

}  // namespace

LiggghtsScreen::LiggghtsScreen()
{
    cookie_io_functions_t functions{};
    functions.write = writeToScreen;
    stream_ = fopencookie(this, "w", functions);
    if (!stream_) {
        throw std::runtime_error("can not open a stream for LIGGGHTS' output");
    }
    // Unbuffered: MPI_Abort does not flush.
    setvbuf(stream_, nullptr, _IONBF, 0);
}

void LiggghtsScreen::write(const char* text, std::size_t size)
{
    for (std::size_t i = 0; i < size; ++i) {
        line_ += text[i];
        if (text[i] == '\n') {
            writeLine(line_);
            line_.clear();
        }
    }
}

void LiggghtsScreen::writeLine(const std::string& line) const
{
    const bool error = holds(line, "ERROR");
    if (quiet_ && !error && !holds(line, "WARNING")) {
        return;
    }
    std::fputs(line.c_str(), stdout);
    if (error && holds(line, "Unknown cohesion model")) {
        std::fprintf(stdout, "This combination of contact models was not built with charging. Known: %s.\n",
                     knownContactModels().c_str());
    }
    if (error && !quiet_ && scriptLine_) {
        std::fprintf(stdout, "The script line was: %s\n", scriptLine_().c_str());
    }
    std::fflush(stdout);
}

}  // namespace him
