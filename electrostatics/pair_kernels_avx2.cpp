// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/pair_loops.hpp"

namespace him {

extern const PairKernels avx2PairKernels;
const PairKernels avx2PairKernels = makeKernels("avx2");

}  // namespace him
