// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "electrostatics/constants.hpp"
#include "electrostatics/types.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace him {

// Drag of a gas on one sphere among others. Every law is stored in one form, that of model A: the gas acts on a sphere of
// volume V_p by
//     F = beta (u - v) + V_p (-grad p),
// with the gas velocity u between the spheres (not the superficial one) and the pressure gradient of the whole mixture.
// Model B has no second term; dragOfModelB() makes the same equilibrium of it.

/// What a drag law looks at. SI units.
struct DragPoint {
    double voidFraction = 1;  ///< share of the volume that is gas, above 0 and up to 1 [-]
    double slip = 0;          ///< |u - v| [m/s]
    double diameter = 0;      ///< of the sphere [m]
    double density = 0;       ///< of the gas [kg/m3]
    double viscosity = 0;     ///< of the gas, dynamic [Pa s]
};

/// What a drag law looks at of many spheres in one gas, one row for each.
struct DragPoints {
    Scalars voidFraction;  ///< [-]
    Scalars slip;          ///< [m/s]
    Scalars diameter;      ///< [m]
    double density = 0;    ///< [kg/m3]
    double viscosity = 0;  ///< [Pa s]

    Index rows() const { return slip.size(); }
    void resize(Index rows)
    {
        voidFraction.resize(rows);
        slip.resize(rows);
        diameter.resize(rows);
    }
    DragPoint at(Index row) const { return {voidFraction[row], slip[row], diameter[row], density, viscosity}; }
};

/// beta of each sphere [kg/s], model A. Finite and above zero at slip 0, where it is the limit. Within some units of round-off what the
/// law gives for one, on one processor the same digits in any order of the spheres. Raises no floating point exception at slip 0 or void fraction 1.
using DragOfMany = void (*)(const DragPoints& points, Scalars& beta);
/// WenYu eight at a time, by the processor's vectors. Laws that take powers on one side of a condition only are left out: in a vector
/// the other side is computed as well, of zeros, and OpenFOAM traps what divides by zero.
void wenYuDragOfMany(const DragPoints& points, Scalars& beta);

/// Names of all laws, in the order of the documentation.
std::vector<std::string> dragLawNames();
/// Throws std::invalid_argument that lists the known names.
DragOfMany dragOfMany(const std::string& name);

/// Whether a law has been shown to hold somewhere, by measurements or simulations that its source rests on.
using DragLawRange = bool (*)(const DragPoint&);

/// That of a law by name. Throws as dragOfMany() does.
DragLawRange dragLawRange(const std::string& name);
/// The same in words, for the log.
std::string dragLawRangeInWords(const std::string& name);
/// Some of the laws: one bit for each, in the order of dragLawNames().
using DragLawSet = unsigned;
/// Those that have been shown to hold somewhere.
DragLawSet dragLawsThatHold(const DragPoint& at);
std::vector<std::string> dragLawNames(DragLawSet set);

/// Reynolds number of the superficial slip, voidFraction density slip diameter / viscosity [-].
inline double superficialReynolds(const DragPoint& at)
{
    return at.voidFraction * at.density * at.slip * at.diameter / at.viscosity;
}

/// Stokes' 3 pi mu d [kg/s], the measure of all laws.
inline double stokesDrag(const DragPoint& at)
{
    return 3 * pi * at.viscosity * at.diameter;
}

/// C_D Re of a single sphere by Schiller and Naumann: 24 (1 + 0.15 Re^0.687), 0.44 Re above Re = 1000 (S2.8 with its 0.44).
inline double singleSphereDragTimesReynolds(double reynolds)
{
    const double slow = 24 * (1 + 0.15 * std::pow(reynolds, 0.687));
    return reynolds < 1000 ? slow : 0.44 * reynolds;
}

/// Wen and Yu 1966, Chem. Eng. Prog. Symp. Ser. 62: single sphere times voidFraction^-1.65 (S2.6, S2.7, S2.8).
inline double wenYuDrag(const DragPoint& at)
{
    // 3/4 C_D alpha rho slip alpha^-2.65 V_p / d, with C_D Re in place of C_D so that slip 0 is no special case.
    return stokesDrag(at) * singleSphereDragTimesReynolds(superficialReynolds(at)) / 24
           * std::pow(at.voidFraction, -2.65);
}

/// Schiller and Naumann 1935: the single sphere at the slip itself, whatever stands around it.
inline double schillerNaumannDrag(const DragPoint& at)
{
    return stokesDrag(at) * singleSphereDragTimesReynolds(at.density * at.slip * at.diameter / at.viscosity) / 24;
}

/// Gidaspow 1994: Ergun's packed bed below void fraction 0.8, else Wen and Yu. Jumps there.
double gidaspowDrag(const DragPoint& at);
/// Ergun 1952, Chem. Eng. Prog. 48, for void fractions of packed beds: 150 and 1.75.
double ergunDrag(const DragPoint& at);
/// Beetstra, van der Hoef, Kuipers 2007, AIChE J. 53, 489.
double beetstraDrag(const DragPoint& at);
/// Di Felice 1994, Int. J. Multiphase Flow 20, 153, with the single sphere of Dallavalle.
double diFeliceDrag(const DragPoint& at);
/// Koch and Hill 2001, Annu. Rev. Fluid Mech. 33, 619, as Kafui et al. and van Buijtenen et al. use it.
double kochHillDrag(const DragPoint& at);

/// beta of model B [kg/s] from that of model A: in steady uniform flow both give the same force on a sphere and the same
/// pressure drop (Gidaspow 1994, section 2.4).
inline double dragOfModelB(double dragOfModelA, double voidFraction)
{
    return dragOfModelA / voidFraction;
}

}  // namespace him
