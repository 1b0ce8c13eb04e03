// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/pair_loops.hpp"

namespace him {

extern const PairKernels baselinePairKernels;
const PairKernels baselinePairKernels = makeKernels("baseline");

}  // namespace him
