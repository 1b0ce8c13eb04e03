// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace him {

/// How a discrete -d2/dx2, times h^2, acts on a wave whose phase changes by theta from cell to cell (0 to pi). The second
/// difference of a finite-volume mesh.
double secondDifferenceSymbol(double theta);

/// The same for the operator that p3m asks of a direct solve on a uniform grounded box: the fourth-order difference
/// (-1, 16, -30, 16, -1)/12 with odd reflection at the walls, times 1 - 0.02 (secondDifferenceSymbol)^2. The factor leaves
/// the fourth order as it is and makes up for the short waves that the least-squares gather loses; 0.02 gives the least
/// field error for charges of both signs and for wall layers alike (measured for cubic and quartic gather, R = 2 to 4 h:
/// between 0.015 and 0.03 the error changes by less than 5 %, without the factor it is 15 to 40 % larger).
double matchedSymbol(double theta);

}  // namespace him
