// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/pair_kernels.hpp"

namespace him {

#if defined(HIM_X86_KERNELS)
extern const PairKernels avx512PairKernels;
extern const PairKernels avx2PairKernels;
#endif
extern const PairKernels baselinePairKernels;

const std::vector<const PairKernels*>& runnablePairKernels()
{
    static const std::vector<const PairKernels*> list = [] {
        std::vector<const PairKernels*> found;
#if defined(HIM_X86_KERNELS)
        if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("fma")) {
            found.push_back(&avx512PairKernels);
        }
        if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
            found.push_back(&avx2PairKernels);
        }
#endif
        found.push_back(&baselinePairKernels);
        return found;
    }();
    return list;
}

}  // namespace him
