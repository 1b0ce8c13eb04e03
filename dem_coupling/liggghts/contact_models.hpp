// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace him {

/// Registers the contact models `charge` and `charge/sjkr` (cohesion slot) and every combination with the normal,
/// tangential and rolling models below, for pairs and walls. Once per process, before LIGGGHTS is constructed.
void registerContactModels();

/// The combinations that exist, for messages.
std::string knownContactModels();

}  // namespace him
