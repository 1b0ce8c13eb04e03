// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
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

/// beta of one sphere [kg/s], model A. Finite and above zero at slip 0, where it is the limit.
using DragLaw = std::function<double(const DragPoint&)>;

/// Names of all laws, in the order of the documentation.
std::vector<std::string> dragLawNames();
/// Throws std::invalid_argument that lists the known names.
DragLaw makeDragLaw(const std::string& name);

/// Whether a law has been shown to hold somewhere, by measurements or simulations that its source rests on.
using DragLawRange = bool (*)(const DragPoint&);

/// That of a law by name. Throws as makeDragLaw() does.
DragLawRange dragLawRange(const std::string& name);
/// The same in words, for the log.
std::string dragLawRangeInWords(const std::string& name);
/// Names of the laws that have been shown to hold at a void fraction [-] and a superficial Reynolds number [-].
std::vector<std::string> dragLawsThatHold(double voidFraction, double reynolds);

/// Reynolds number of the superficial slip, voidFraction density slip diameter / viscosity [-].
double superficialReynolds(const DragPoint& at);
/// C_D Re of a single sphere by Schiller and Naumann: 24 (1 + 0.15 Re^0.687), 0.44 Re above Re = 1000 (S2.8 with its 0.44).
double singleSphereDragTimesReynolds(double reynolds);

/// Wen and Yu 1966, Chem. Eng. Prog. Symp. Ser. 62: single sphere times voidFraction^-1.65 (S2.6, S2.7, S2.8).
double wenYuDrag(const DragPoint& at);
/// Schiller and Naumann 1935: the single sphere at the slip itself, whatever stands around it.
double schillerNaumannDrag(const DragPoint& at);
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
