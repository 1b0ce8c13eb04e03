// SPDX-License-Identifier: GPL-3.0-or-later
#include "himField/comparison.H"

#include "himField/referenceField.H"
#include "settings/checkedDictionary.H"

#include <algorithm>
#include <cmath>

namespace him {

namespace {

/// Every so many particles one is moved for the warm calls.
constexpr Index movedEvery = 50;

/// How far, in cells; not half a cell, which would put spheres that touch a wall onto it on common meshes.
constexpr double movedCells = 0.35;

/// Pairs that pairwiseSum may sum in one field before it is left out of a comparison that does not name it.
constexpr double mostPairs = 2e10;

/// A method on trial.
struct trial {
    std::unique_ptr<timedMethod> method;
    std::vector<callTimes> cold, warm;
    double seconds = 0;
};

std::vector<comparedMethod> wanted(const snapshot& s, const comparisonOptions& options, Index particles)
{
    std::vector<comparedMethod> list;
    for (const fieldChoice& choice : s.choices.all) {
        const auto& names = options.names;
        const bool named = std::find(names.begin(), names.end(), choice.name) != names.end();
        if (!named && !names.empty()) {
            continue;
        }
        comparedMethod method;
        method.name = choice.name;
        method.settings = s.complete(choice.settings);
        const Complaints complaints = FieldMethod::check(method.settings, s.poisson.get(), s.box, s.periodic);
        const double images = method.settings.pairwiseSum.images ? 27 : 1;
        const double pairs = images * std::pow(static_cast<double>(particles), 2);
        if (!complaints.none()) {
            method.leftOut = complaints.lines().front();
        } else if (method.settings.pairwiseSum.images && !s.walls.refusal.empty()) {
            method.leftOut = "no images: " + s.walls.refusal;
        } else if (!named && choice.settings.method == "pairwiseSum" && pairs > mostPairs) {
            method.leftOut = shown(pairs, 2) + " pairs; name the method in -methods to have it run";
        }
        list.push_back(method);
    }
    return list;
}

/// The particles after every 50th has moved by movedCells, or a hundredth of the box of the particles without a mesh;
/// where that leads out of the mesh it stays.
DemParticles moved(const DemParticles& particles, const snapshot& s)
{
    const double size = s.poisson ? s.poisson->largestCellDiagonal() / std::sqrt(3.0) : 0;
    DemParticles after = particles;
    for (Index row = 0; row < particles.size(); ++row) {
        const auto tag = static_cast<Index>(particles.tag[static_cast<std::size_t>(row)]);
        if (tag % movedEvery != 1) {
            continue;
        }
        const Index axis = (tag / movedEvery) % 3;
        const double step = size > 0 ? movedCells * size : 0.01 * particles.position.col(axis).abs().maxCoeff();
        for (const double sign : {1.0, -1.0}) {
            Vector3 place = particles.position.row(row).matrix().transpose();
            place[axis] += sign * step;
            if (!s.poisson || s.poisson->findCell(place) >= 0) {
                after.position.row(row) = place.transpose().array();
                break;
            }
        }
    }
    return after;
}

void startFromNothing(snapshot& s)
{
    if (s.poisson) {
        s.poisson->forgetPotential();
    }
}

/// First field from nothing, with memory and error to come from it. Collective.
void firstField(snapshot& s, const particleShares& shares, MPI_Comm communicator, comparedMethod& method, trial& t)
{
    startFromNothing(s);
    restartPeak();
    const double before = residentMemory(communicator);
    t.method = std::make_unique<timedMethod>(method.settings, s, communicator);
    const callTimes first = t.method->call(shares.own());
    method.firstSeconds = t.method->createSeconds() + first.total;
    method.growthMiB = residentMemory(communicator) - before;
    method.peakMiB = peakMemory(communicator);
    method.neighbours = static_cast<double>(t.method->result().pairs) / static_cast<double>(shares.total());
    t.seconds = method.firstSeconds;
}

void judge(const referenceField& reference, const Vector3& externalField, const Points& field, comparedMethod& method)
{
    Points error(static_cast<Index>(reference.rows.size()), 3);
    for (std::size_t n = 0; n < reference.rows.size(); ++n) {
        error.row(static_cast<Index>(n)) = field.row(reference.rows[n]) - reference.field.row(static_cast<Index>(n));
    }
    const double scale = normsOf(reference.field.rowwise() - externalField.transpose().array()).rms;
    const errorNorms norms = normsOf(error);
    method.judged = scale > 0;
    method.rmsAbsolute = norms.rms;
    method.rmsError = method.judged ? norms.rms / scale : 0;
    method.largestError = method.judged ? norms.largest / scale : 0;
}

/// One round: a cold and a warm call of every method, beginning with another one each time.
void timeRound(snapshot& s, const DemParticles& before, const DemParticles& after, int round,
               const comparisonOptions& options, std::vector<trial>& trials)
{
    for (std::size_t n = 0; n < trials.size(); ++n) {
        trial& t = trials[(n + static_cast<std::size_t>(round)) % trials.size()];
        if (!t.method || (round > 0 && t.seconds > options.longestSeconds)) {
            continue;
        }
        startFromNothing(s);
        t.cold.push_back(t.method->call(before));
        t.warm.push_back(t.method->call(after));
        t.seconds += t.cold.back().total + t.warm.back().total;
    }
}

/// The slowest rank's seconds, so that all ranks agree on who gets another round.
void agree(std::vector<trial>& trials, MPI_Comm communicator)
{
    for (trial& t : trials) {
        MPI_Bcast(&t.seconds, 1, MPI_DOUBLE, 0, communicator);
    }
}

std::vector<FieldSettings> settingsOf(const std::vector<comparedMethod>& methods)
{
    std::vector<FieldSettings> list;
    for (const comparedMethod& method : methods) {
        if (method.leftOut.empty()) {
            list.push_back(method.settings);
        }
    }
    return list;
}

std::string describeMesh(const snapshot& s)
{
    if (!s.poisson) {
        return {};
    }
    const std::string text = s.poisson->description();
    const Foam::label cells = Foam::returnReduce(s.mesh().nCells(), Foam::sumOp<Foam::label>());
    return text.empty() ? std::to_string(cells) + " cells" : text;
}

}  // namespace

comparison compareMethods(snapshot& s, const particleTable& table, const particleShares& shares,
                          const comparisonOptions& options, MPI_Comm communicator)
{
    comparison result;
    result.particles = shares.total();
    result.cellSize = s.cellSize;
    MPI_Comm_size(communicator, &result.ranks);
    result.methods = wanted(s, options, shares.total());
    const referenceField reference = findReference(s, table, shares, settingsOf(result.methods), communicator);
    result.reference = reference.description;
    result.judgedParticles = static_cast<Index>(reference.rows.size());

    std::vector<trial> trials(result.methods.size());
    for (std::size_t n = 0; n < trials.size(); ++n) {
        comparedMethod& method = result.methods[n];
        if (!method.leftOut.empty()) {
            continue;
        }
        Foam::Info << "    " << method.name.c_str() << Foam::endl;
        try {
            firstField(s, shares, communicator, method, trials[n]);
        } catch (const std::exception& failure) {  // the same on every rank
            method.leftOut = failure.what();
            trials[n].method.reset();
            continue;
        }
        const Points field = shares.gathered(trials[n].method->result().field);
        if (Foam::Pstream::master() && !reference.description.empty()) {
            judge(reference, method.settings.externalField, field, method);
        }
    }
    const DemParticles after = moved(shares.own(), s);
    for (int round = 0; round < options.rounds; ++round) {
        agree(trials, communicator);
        timeRound(s, shares.own(), after, round, options, trials);
    }
    for (std::size_t n = 0; n < trials.size(); ++n) {
        result.methods[n].rounds = static_cast<int>(trials[n].cold.size());
        if (result.methods[n].rounds > 0) {
            result.methods[n].cold = medianOf(trials[n].cold);
            result.methods[n].warm = medianOf(trials[n].warm);
        }
    }
    result.mesh = describeMesh(s);  // by now it is known whether the mesh is solved directly
    return result;
}

}  // namespace him
