// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/p3m/local_polynomial.hpp"

namespace him {

void monomials(const Vector3& xi, int order, double* out)
{
    int n = 0;
    for (int degree = 1; degree <= order; ++degree) {
        for (int a = degree; a >= 0; --a) {
            for (int b = degree - a; b >= 0; --b) {
                const int c = degree - a - b;
                double value = 1;
                for (int i = 0; i < a; ++i) {
                    value *= xi[0];
                }
                for (int i = 0; i < b; ++i) {
                    value *= xi[1];
                }
                for (int i = 0; i < c; ++i) {
                    value *= xi[2];
                }
                out[n++] = value;
            }
        }
    }
}

void derivatives(const Vector3& xi, const Vector3& direction, int order, double* out)
{
    const auto power = [](double base, int exponent) {
        double value = 1;
        for (int i = 0; i < exponent; ++i) {
            value *= base;
        }
        return value;
    };
    int n = 0;
    for (int degree = 1; degree <= order; ++degree) {
        for (int a = degree; a >= 0; --a) {
            for (int b = degree - a; b >= 0; --b) {
                const int c = degree - a - b;
                double value = 0;
                if (a > 0) {
                    value += direction[0] * a * power(xi[0], a - 1) * power(xi[1], b) * power(xi[2], c);
                }
                if (b > 0) {
                    value += direction[1] * b * power(xi[0], a) * power(xi[1], b - 1) * power(xi[2], c);
                }
                if (c > 0) {
                    value += direction[2] * c * power(xi[0], a) * power(xi[1], b) * power(xi[2], c - 1);
                }
                out[n++] = value;
            }
        }
    }
}

/// Written out, because it is called once per particle. The parts of equal degree d give their value by Euler's theorem,
/// p_d = xi . grad p_d / d.
void LocalPolynomial::evaluate(const Vector3& place, double& valueThere, Vector3& gradient) const
{
    const Vector3 xi = scale * (place - centre);
    const double x = xi[0], y = xi[1], z = xi[2];
    const double* c = coefficients.data();
    Vector3 g(c[0], c[1], c[2]);
    valueThere = value + xi.dot(g);
    const auto add = [&](int degree, const Vector3& part) {
        g += part;
        valueThere += xi.dot(part) / degree;
    };
    if (order >= 2) {
        add(2, Vector3(2 * c[3] * x + c[4] * y + c[5] * z, c[4] * x + 2 * c[6] * y + c[7] * z,
                       c[5] * x + c[7] * y + 2 * c[8] * z));
    }
    if (order >= 3) {
        // 9 x3, 10 x2y, 11 x2z, 12 xy2, 13 xyz, 14 xz2, 15 y3, 16 y2z, 17 yz2, 18 z3
        const double xx = x * x, yy = y * y, zz = z * z, xy = x * y, xz = x * z, yz = y * z;
        add(3, Vector3(3 * c[9] * xx + 2 * c[10] * xy + 2 * c[11] * xz + c[12] * yy + c[13] * yz + c[14] * zz,
                       c[10] * xx + 2 * c[12] * xy + c[13] * xz + 3 * c[15] * yy + 2 * c[16] * yz + c[17] * zz,
                       c[11] * xx + c[13] * xy + 2 * c[14] * xz + c[16] * yy + 2 * c[17] * yz + 3 * c[18] * zz));
        if (order >= 4) {
            // 19 x4, 20 x3y, 21 x3z, 22 x2y2, 23 x2yz, 24 x2z2, 25 xy3, 26 xy2z, 27 xyz2, 28 xz3,
            // 29 y4, 30 y3z, 31 y2z2, 32 yz3, 33 z4
            add(4, Vector3(
                       xx * (4 * c[19] * x + 3 * c[20] * y + 3 * c[21] * z)
                           + 2 * x * (c[22] * yy + c[23] * yz + c[24] * zz) + yy * (c[25] * y + c[26] * z)
                           + zz * (c[27] * y + c[28] * z),
                       xx * (c[20] * x + 2 * c[22] * y + c[23] * z) + x * (3 * c[25] * yy + 2 * c[26] * yz + c[27] * zz)
                           + yy * (4 * c[29] * y + 3 * c[30] * z) + zz * (2 * c[31] * y + c[32] * z),
                       xx * (c[21] * x + c[23] * y + 2 * c[24] * z) + x * (c[26] * yy + 2 * c[27] * yz + 3 * c[28] * zz)
                           + yy * (c[30] * y + 2 * c[31] * z) + zz * (3 * c[32] * y + 4 * c[33] * z)));
        }
    }
    gradient = scale.transpose() * g;
}

}  // namespace him
