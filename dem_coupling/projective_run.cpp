// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/projective_run.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace him {

namespace {

/// Columns of the particles' notes.
constexpr int knownColumn = 0;  // 0: came in during the burst, 1: has a mark, 2: has the rest of the last burst, too
constexpr int markColumn = 1;   // charge at the start of the burst [C]
constexpr int restColumn = 2;   // beyond the fit in the last burst [C]
constexpr int noteColumns = 3;

/// Weight of what older bursts tell about the correlation, per burst.
constexpr double memory = 0.8;

}  // namespace

ProjectiveRun::ProjectiveRun(const ProjectiveSettings& settings, DemPort& dem, WallChargePort* faces,
                             MPI_Comm communicator)
    : settings_(settings), dem_(dem), faces_(faces), communicator_(communicator)
{
    dem_.keepNotes(noteColumns);
}

void ProjectiveRun::start(double time)
{
    DemParticles particles;
    dem_.particles(particles);
    Notes notes;
    dem_.notes(notes);
    Scalars rest(particles.size());
    for (Index row = 0; row < rest.size(); ++row) {
        // Rests of bursts like these are known in a run that continues; NaN stands for none.
        rest[row] = sameBursts_ && notes(row, knownColumn) == 2 ? notes(row, restColumn) : std::nan("");
    }
    beginBurst(particles, rest, time);
}

void ProjectiveRun::beginBurst(const DemParticles& particles, const Scalars& rest, double time)
{
    Notes notes(particles.size(), noteColumns);
    for (Index row = 0; row < particles.size(); ++row) {
        const bool known = !std::isnan(rest[row]);
        notes(row, knownColumn) = known ? 2 : 1;
        notes(row, markColumn) = particles.charge[row];
        notes(row, restColumn) = known ? rest[row] : 0;
    }
    dem_.setNotes(notes);
    wallMarks_ = dem_.movements().toWall;
    if (faces_) {
        faces_->mark();
    }
    burstStart_ = time;
    updates_ = 0;
}

bool ProjectiveRun::update(DemParticles& particles, double time)
{
    if (++updates_ < settings_.burst) {
        return false;
    }
    Notes notes;
    dem_.notes(notes);
    std::vector<Index> rows;
    for (Index row = 0; row < particles.size(); ++row) {
        if (notes(row, knownColumn) > 0) {
            rows.push_back(row);
        }
    }
    const Scalars share = sharesOf(particles);
    Scalars before(static_cast<Index>(rows.size())), after(before.size()), shareOfRow(before.size());
    std::vector<int> group;
    for (std::size_t n = 0; n < rows.size(); ++n) {
        before[static_cast<Index>(n)] = notes(rows[n], markColumn);
        after[static_cast<Index>(n)] = particles.charge[rows[n]];
        shareOfRow[static_cast<Index>(n)] = share[rows[n]];
        group.push_back(particles.type[static_cast<std::size_t>(rows[n])] - 1);
    }
    // Of the particles that are there now: others may have come in since the last burst.
    std::vector<std::vector<double>> equilibrium(static_cast<std::size_t>(dem_.particleTypes()));
    for (const WallEquilibrium& one : dem_.equilibria()) {
        equilibrium[static_cast<std::size_t>(one.particleType - 1)].push_back(one.charge);
    }

    const ChargeProjection projection(before, after, shareOfRow, group, equilibrium, communicator_);
    burstGains_ = dem_.movements().toWall;
    double activity = faces_ ? faces_->activity() : 0;
    for (std::size_t wall = 0; wall < burstGains_.size(); ++wall) {
        burstGains_[wall] -= wallMarks_.empty() ? 0 : wallMarks_[wall];
        activity += std::fabs(burstGains_[wall]);
    }
    record_.time = time;
    record_.gain = projection.totalGain();
    record_.expected = record_.assumed;
    record_.error = expects_ ? projectionError(record_.expected, record_.gain) : 0;
    if (expects_) {
        ++errors_;
        sumOfErrors_ += record_.error;
        largestError_ = std::max(largestError_, record_.error);
    }
    record_.correlation = correlate(notes, projection.rest(), rows);
    const ChargeProjection::Leap leap = projection.leap(settings_.leap, record_.correlation, activity > 0);

    Scalars rest = Scalars::Constant(particles.size(), std::nan(""));
    for (std::size_t n = 0; n < rows.size(); ++n) {
        particles.charge[rows[n]] = leap.charge[static_cast<Index>(n)];
        rest[rows[n]] = projection.rest()[static_cast<Index>(n)];
    }
    dem_.setCharges(particles.charge);
    record_.leapGain = leap.gained;
    record_.givenToWalls = activity > 0 ? settleWalls(leap.gained, record_.gain) : 0;
    record_.assumed = leap.assumedGain;
    record_.stopped = leap.stopped;
    record_.fits = projection.groups();
    record_.beyond += static_cast<double>(settings_.leap) * (time - burstStart_);
    expects_ = true;
    ++leaps_;
    beginBurst(particles, rest, time);
    return true;
}

/// (d/mean d of the type)^2 of each particle: the equilibrium charges of the DEM are those of the mean diameters.
Scalars ProjectiveRun::sharesOf(const DemParticles& particles) const
{
    std::vector<double> sums(2 * static_cast<std::size_t>(dem_.particleTypes()), 0.0);
    const auto of = [&](Index row) {
        return &sums[2 * static_cast<std::size_t>(particles.type[static_cast<std::size_t>(row)] - 1)];
    };
    for (Index row = 0; row < particles.size(); ++row) {
        of(row)[0] += 1;
        of(row)[1] += particles.radius[row];
    }
    MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM, communicator_);
    Scalars share(particles.size());
    for (Index row = 0; row < share.size(); ++row) {
        const double mean = of(row)[1] / of(row)[0];
        share[row] = particles.radius[row] * particles.radius[row] / (mean * mean);
    }
    return share;
}

double ProjectiveRun::correlate(const Notes& notes, const Scalars& rest, const std::vector<Index>& rows)
{
    std::array<double, 2> sums{};
    for (std::size_t n = 0; n < rows.size(); ++n) {
        if (notes(rows[n], knownColumn) == 2) {
            const double now = rest[static_cast<Index>(n)], then = notes(rows[n], restColumn);
            sums[0] += now * then;
            sums[1] += 0.5 * (now * now + then * then);
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, sums.data(), 2, MPI_DOUBLE, MPI_SUM, communicator_);
    together_ = memory * together_ + sums[0];
    squares_ = memory * squares_ + sums[1];
    return squares_ > 0 ? together_ / squares_ : 0;
}

/// Gives the walls -gained [C], in proportion to their burst. Returns what they got.
double ProjectiveRun::settleWalls(double gained, double burstGain)
{
    const double longest = static_cast<double>(settings_.leap);
    const double times = burstGain != 0 ? std::clamp(gained / burstGain, 0.0, longest) : longest;
    double sum = 0, activity = 0, keptActivity = 0;
    const auto keeps = [this](std::size_t wall) { return faces_ && faces_->keeps(wall); };
    for (std::size_t wall = 0; wall < burstGains_.size(); ++wall) {
        sum += burstGains_[wall];
        (keeps(wall) ? keptActivity : activity) += std::fabs(burstGains_[wall]);
    }
    const double faceActivity = faces_ ? faces_->activity() : 0;
    const double perActivity = (-gained - times * sum) / (activity + faceActivity);
    std::vector<double> given(burstGains_.size());
    for (std::size_t wall = 0; wall < given.size(); ++wall) {
        const double mine = std::fabs(burstGains_[wall]);
        // The faces of all insulating walls share by their own activity, which is larger than that of the walls' sums.
        const double scale = !keeps(wall) ? 1 : keptActivity > 0 ? faceActivity / keptActivity : 0;
        given[wall] = times * burstGains_[wall] + perActivity * scale * mine;
    }
    if (faces_) {
        faces_->continueSinceMark(times, perActivity);
        if (keptActivity == 0 && faceActivity > 0) {
            // Gains and losses of every wall's faces cancelled: any of them stands for all.
            for (std::size_t wall = 0; wall < given.size(); ++wall) {
                if (keeps(wall)) {
                    given[wall] += perActivity * faceActivity;
                    break;
                }
            }
        }
    }
    dem_.giveToWalls(given);
    double all = 0;
    for (const double one : given) {
        all += one;
    }
    return all;
}

std::string ProjectiveRun::state() const
{
    std::ostringstream text;
    text.precision(17);
    text << settings_.burst << ' ' << settings_.leap << ' ' << record_.beyond << ' ' << record_.assumed << ' '
         << expects_ << ' ' << together_ << ' ' << squares_ << ' ' << leaps_ << ' ' << errors_ << ' ' << sumOfErrors_
         << ' ' << largestError_;
    return text.str();
}

bool ProjectiveRun::restore(const std::string& state)
{
    std::istringstream text(state);
    long burst = 0, leap = 0, leaps = 0, errors = 0;
    double beyond = 0, assumed = 0, together = 0, squares = 0, sumOfErrors = 0, largestError = 0;
    bool expects = false;
    if (!(text >> burst >> leap >> beyond >> assumed >> expects >> together >> squares >> leaps >> errors >> sumOfErrors
          >> largestError)) {
        return false;
    }
    record_.beyond = beyond;
    // What other bursts gave and expected says nothing of the next one.
    sameBursts_ = burst == settings_.burst;
    if (sameBursts_) {
        record_.assumed = assumed;
        expects_ = expects;
        together_ = together;
        squares_ = squares;
    }
    leaps_ = leaps;
    errors_ = errors;
    sumOfErrors_ = sumOfErrors;
    largestError_ = largestError;
    return true;
}

}  // namespace him
