// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <exception>
#include <string>

namespace him {

/// Text of the exception that the call throws, or "nothing was refused".
template <class Call> std::string refusal(Call call)
{
    try {
        call();
    } catch (const std::exception& error) {
        return error.what();
    }
    return "nothing was refused";
}

}  // namespace him
