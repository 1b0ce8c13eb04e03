// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/pair_loops.hpp"

namespace him {

extern const PairKernels avx512PairKernels;
const PairKernels avx512PairKernels = makeKernels("avx512");

}  // namespace him
