// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/liggghts/charge_gran_contact_options.hpp"

#include "dem_coupling/liggghts/word_reader.hpp"
#include "electrostatics/constants.hpp"

#include <cmath>
#include <functional>
#include <set>
#include <stdexcept>

namespace him {

namespace {

constexpr const char* knownKeywords =
    "pair, area, reloading, curvature, workFunction, workFunctionEV, deltaE, saturationCharge, sizeLaw, spread, update, ownImage, "
    "wallField, acceleration, realModulus, relaxationTime, breakdownField, initialCharge, wall";

class OptionsReader {
public:
    OptionsReader(const std::vector<std::string>& words, int types)
        : options_(types),
          words_(words, complaints_),
          readers_{{"pair", [this] { readPair(); }},
                   {"area", [this] { options_.area = areaLawByName(words_.word("area")); }},
                   {"reloading", [this] { readReloading(); }},
                   {"curvature", [this] { options_.curvature = words_.number("curvature"); }},
                   {"workFunction", [this] { readWorkFunction("workFunction", 1); }},
                   {"workFunctionEV", [this] { readWorkFunction("workFunctionEV", elementaryCharge); }},
                   {"deltaE", [this] { options_.pairs.setSeparation(words_.number("deltaE")); }},
                   {"saturationCharge", [this] { readSaturationCharge(); }},
                   {"sizeLaw", [this] { readSizeLaw(); }},
                   {"spread", [this] { readSpread(); }},
                   {"update", [this] { options_.update = withinContactByName(words_.word("update")); }},
                   {"ownImage",
                    [this] {
                        options_.ownImage = words_.oneOf("ownImage", {"excluded", "included"}) == 1;
                    }},
                   {"wallField",
                    [this] {
                        options_.atContactPoint = words_.oneOf("wallField", {"centre", "atContactPoint"}) == 1;
                    }},
                   {"acceleration", [this] { options_.pairs.setAcceleration(words_.number("acceleration")); }},
                   {"realModulus", [this] { readRealModulus(types_); }},
                   {"relaxationTime", [this] { options_.losses.setRelaxationTime(words_.number("relaxationTime")); }},
                   {"breakdownField", [this] { options_.losses.setBreakdownField(words_.number("breakdownField")); }},
                   {"initialCharge", [this] { readInitialCharge(); }},
                   {"wall", [this] { readWall(); }}},
          types_(types)
    {
    }

    ChargeGranContactOptions read()
    {
        const std::set<std::string> repeatable{"pair",    "workFunction", "workFunctionEV", "saturationCharge",
                                               "sizeLaw", "spread",       "realModulus",    "initialCharge", "wall"};
        std::set<std::string> given;
        while (!words_.done()) {
            const std::string keyword = words_.word("");
            const auto reader = readers_.find(keyword);
            if (reader == readers_.end()) {
                throw std::invalid_argument("unknown keyword '" + keyword + "'; known: " + knownKeywords);
            }
            if (!given.insert(keyword).second && !repeatable.count(keyword)) {
                complaints_.add(keyword, "given twice");
            }
            const std::size_t before = complaints_.lines().size();
            try {
                reader->second();
            } catch (const std::invalid_argument& wrong) {
                // After words that could not be read, what follows is out of step.
                if (complaints_.lines().size() == before) {
                    throw;
                }
                throw std::invalid_argument(complaints_.text() + wrong.what());
            }
        }
        if (complaints_.none()) {
            complaints_.add(options_.pairs.check());
            options_.initial.check(options_.pairs, complaints_);
        }
        if (!complaints_.none()) {
            throw std::invalid_argument(complaints_.text());
        }
        return std::move(options_);
    }

private:
    /// `kappa K`
    double efficiency(const std::string& after)
    {
        words_.expect("kappa", after);
        return words_.number("kappa");
    }

    void readPair()
    {
        const int first = words_.whole("pair");
        const int second = words_.whole("pair");
        const std::string what = words_.word("pair I J");
        ChargingPairs& pairs = options_.pairs;
        if (what == "none") {
            pairs.setNone(first, second);
        } else if (what == "gamma") {
            const double gamma = words_.number("gamma");
            pairs.set(first, second, gamma, efficiency("gamma <V/m>"));
        } else if (what == "saturationCharge") {
            const SaturationLaw law = saturationCharge("saturationCharge");
            pairs.setAtWall(first, second, law, efficiency("saturationCharge <C> radius <m>"));
        } else if (what == "sizeLaw") {
            const SaturationLaw law = sizeLaw("sizeLaw");
            pairs.setAtWall(first, second, law, efficiency("sizeLaw <C/m2> <V>"));
        } else if (what == "saturation") {
            pairs.setFromSaturations(first, second, efficiency("saturation"));
        } else if (what == "workFunctions") {
            pairs.setFromWorkFunctions(first, second, efficiency("workFunctions"));
        } else {
            throw std::invalid_argument("after 'pair I J' comes 'gamma <V/m> kappa <->' or 'none', found '" + what
                                        + "'; other laws: saturationCharge <C> radius <m>, sizeLaw <C/m2> <V>, saturation, "
                                          "workFunctions, each with kappa <->");
        }
    }

    SaturationLaw saturationCharge(const std::string& after)
    {
        const double charge = words_.number(after);
        words_.expect("radius", after + " <C>");
        const double radius = words_.positive("radius", "[m]");
        return radius > 0 ? saturationOfSphere(charge, radius) : SaturationLaw{};
    }

    SaturationLaw sizeLaw(const std::string& after)
    {
        const double density = words_.number(after);
        return {density, words_.number(after + " <C/m2>")};
    }

    void readSaturationCharge()
    {
        const int type = words_.whole("saturationCharge");
        options_.pairs.setSaturation(type, saturationCharge("saturationCharge <type>"));
    }

    void readSizeLaw()
    {
        const int type = words_.whole("sizeLaw");
        options_.pairs.setSaturation(type, sizeLaw("sizeLaw <type>"));
    }

    void readReloading()
    {
        const std::string name = words_.word("reloading");
        if (name != "counted" && name != "beyondMaximum") {
            throw std::invalid_argument("unknown reloading '" + name + "'; known: counted, beyondMaximum");
        }
        options_.reloading = name == "counted" ? Reloading::counted : Reloading::beyondMaximum;
    }

    void readWorkFunction(const std::string& keyword, double unit)
    {
        const int type = words_.whole(keyword);
        const double value = words_.number(keyword + " <type>");
        // A number that is no joule is caught there; one in joules that was called electron volts is caught here.
        if (unit != 1 && value > 0 && value < 1e-3) {
            complaints_.add(keyword, "found " + words_.last() + " eV, and work functions of solids are a few eV. Write joules with 'workFunction'");
            return;
        }
        options_.pairs.setWorkFunction(type, value * unit);
    }

    void readSpread()
    {
        const int type = words_.whole("spread");
        const std::string what = words_.word("spread <type>");
        ParticleSpread spread;
        spread.deviation = words_.number("spread <type> " + what);
        words_.expect("seed", "spread <type> " + what + " <standard deviation>");
        spread.seed = words_.seed("seed");
        if (what == "gamma") {
            options_.pairs.setSpread(type, spread);
        } else if (what == "workFunction" || what == "workFunctionEV") {
            spread.deviation *= what == "workFunction" ? 1 : elementaryCharge;
            options_.pairs.setWorkFunctionSpread(type, spread);
        } else {
            complaints_.add("spread", "unknown word '" + what + "'; known: gamma, workFunction, workFunctionEV");
        }
    }

    void readRealModulus(int types)
    {
        const int type = words_.whole("realModulus");
        const double modulus = words_.positive("realModulus <type>", "[Pa]");
        if (type < 1 || type > types) {
            complaints_.add("realModulus", "there is no type " + std::to_string(type) + "; the box has types 1 to " + std::to_string(types));
        } else if (!options_.realModuli.emplace(type, modulus).second) {
            complaints_.add("realModulus", "type " + std::to_string(type) + " is given twice");
        }
    }

    void readInitialCharge()
    {
        const int type = words_.whole("initialCharge");
        const std::string what = words_.word("initialCharge <type>");
        if (what == "value") {
            options_.initial.setValue(type, words_.number("value"));
        } else if (what == "normal") {
            const double mean = words_.number("normal");
            ParticleSpread spread;
            spread.deviation = words_.number("normal <mean C>");
            words_.expect("seed", "normal <mean C> <standard deviation C>");
            spread.seed = words_.seed("seed");
            options_.initial.setNormal(type, mean, spread);
        } else if (what == "equilibriumFraction") {
            const double fraction = words_.number("equilibriumFraction");
            words_.expect("wallType", "equilibriumFraction <->");
            options_.initial.setEquilibriumFraction(type, fraction, words_.whole("wallType"));
        } else {
            throw std::invalid_argument("after 'initialCharge <type>' comes 'value <C>', 'normal <mean C> <standard deviation C> seed <n>' or "
                                        "'equilibriumFraction <-> wallType <type>', found '" + what + "'");
        }
    }

    void readWall()
    {
        const std::string name = words_.word("wall");
        const std::string kind = words_.word("wall <name>");
        if (kind == "conductor") {
            options_.walls.push_back({name, true});
        } else if (kind == "none") {
            options_.walls.push_back({name, false});
        } else {
            complaints_.add("wall " + name, "unknown kind '" + kind
                                                + "'; known: conductor (what it is given flows to its voltage source or to ground), none (no "
                                                  "charge transfer). The voltage of a conductor is set where the field is: in "
                                                  "0/electricPotential");
        }
    }

    Complaints complaints_;
    ChargeGranContactOptions options_;
    WordReader words_;
    const std::map<std::string, std::function<void()>> readers_;
    int types_;
};

}  // namespace

ChargeGranContactOptions readChargeGranContactOptions(const std::vector<std::string>& words, int types)
{
    return OptionsReader(words, types).read();
}

}  // namespace him
