// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/gas/drag_law.hpp"
#include "electrostatics/processor_clones.hpp"

#include <algorithm>

#if defined(__x86_64__) && defined(__GLIBC_PREREQ)
#if __GLIBC_PREREQ(2, 35)
// Its vector form in libmvec, within 4 units of round-off. The C library's own header mentions it under -ffast-math only.
extern "C" {
__attribute__((simd("notinbranch"))) double pow(double, double) noexcept;
}
#endif
#endif

namespace him {

namespace {

// The compiler may compute a power on lanes whose condition says otherwise, of zeros: 0^0.687 sets off no trap.

/// Spheres that are computed together. All go through the same vector code, so that a sphere's neighbours do not change its digits.
constexpr Index together = 8;

}  // namespace

HIM_CLONES void wenYuDragOfMany(const DragPoints& points, Scalars& beta)
{
    const Index rows = points.rows();
    beta.resize(rows);
    double lastVoidFraction[together], lastSlip[together], lastDiameter[together], found[together];
    for (Index row = 0; row < rows; row += together) {
        const double* voidFraction = points.voidFraction.data() + row;
        const double* slip = points.slip.data() + row;
        const double* diameter = points.diameter.data() + row;
        const Index count = std::min(together, rows - row);
        if (count < together) {
            for (Index n = 0; n < together; ++n) {
                const Index from = std::min(n, count - 1);
                lastVoidFraction[n] = voidFraction[from];
                lastSlip[n] = slip[from];
                lastDiameter[n] = diameter[from];
            }
            voidFraction = lastVoidFraction;
            slip = lastSlip;
            diameter = lastDiameter;
        }
        for (Index n = 0; n < together; ++n) {
            found[n] = wenYuDrag({voidFraction[n], slip[n], diameter[n], points.density, points.viscosity});
        }
        std::copy_n(found, count, beta.data() + row);
    }
}

}  // namespace him
