// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/p3m/cloud_deposit.hpp"

#include "electrostatics/constants.hpp"
#include "electrostatics/p3m/blocks.hpp"

#include <Eigen/Cholesky>

namespace him {

namespace {

struct Cloud {
    double x, y, z;        ///< centre [m]
    double inverseSquare;  ///< 1/R^2 [1/m2]
    double sign;
};

/// Adds the weights V (1 - u^2)^k of one cloud at `blocks` blocks of cells to `weight`, times the sign to `cloud`.
/// @return sum of the weights, unsigned [m3]
template <int exponent>
inline __attribute__((always_inline)) double addWeights(const Cloud& c, Index blocks, const double* x, const double* y,
                                                        const double* z, const double* volume, double* cloud)
{
    Block sum{};
    for (Index n = 0; n < blocks * blockSize; n += blockSize) {
        const Block dx = load(x + n) - c.x;
        const Block dy = load(y + n) - c.y;
        const Block dz = load(z + n) - c.z;
        Block m = 1.0 - (dx * dx + dy * dy + dz * dz) * c.inverseSquare;
        m = m > 0.0 ? m : Block{};
        if constexpr (exponent == 2) {
            m = m * m;
        }
        const Block w = m * load(volume + n);
        sum += w;
        store(cloud + n, load(cloud + n) + w * c.sign);
    }
    return sumOf(sum);
}

HIM_CLONES double addWeights1(const Cloud& c, Index blocks, const double* x, const double* y, const double* z,
                              const double* volume, double* cloud)
{
    return addWeights<1>(c, blocks, x, y, z, volume, cloud);
}

HIM_CLONES double addWeights2(const Cloud& c, Index blocks, const double* x, const double* y, const double* z,
                              const double* volume, double* cloud)
{
    return addWeights<2>(c, blocks, x, y, z, volume, cloud);
}

/// Copies whole blocks: what a block holds behind its range is overwritten by the next one.
HIM_CLONES void packRanges(const RowRange* range, const RowRange* last, const double* from, double* to)
{
    for (; range != last; ++range) {
        const Index length = range->end - range->begin;
        for (Index n = 0; n < length; n += blockSize) {
            store(to + n, load(from + range->begin + n));
        }
        to += length;
    }
}

}  // namespace

CloudDeposit::CloudDeposit(const LocalMesh& mesh, SurroundingsTable& table, double radius, int exponent)
    : mesh_(mesh),
      table_(table),
      radius_(radius),
      exponent_(exponent),
      amplitude_((exponent == 1 ? 15.0 / 8.0 : 105.0 / 32.0) / (pi * radius * radius * radius))
{
    const auto take = [&](Scalars& to, const auto& from) {
        to.setZero(mesh.cells() + blockSize);
        to.head(mesh.cells()) = from;
    };
    take(cellX_, mesh.centre.col(0));
    take(cellY_, mesh.centre.col(1));
    take(cellZ_, mesh.centre.col(2));
    take(cellVolume_, mesh.volume);
}

/// The cells of all ranges, packed without gaps, so that many charges of one cell are summed in whole blocks.
void CloudDeposit::loadCells(const Surroundings& around)
{
    const Index padded = (around.count + blockSize - 1) / blockSize * blockSize;
    if (x_.size() < padded + blockSize) {
        for (Scalars* values : {&x_, &y_, &z_, &volume_, &cloud_, &charge_}) {
            values->setZero(2 * padded + blockSize);
        }
    }
    packRanges(around.cells.data(), around.cells.data() + around.cells.size(), cellX_.data(), x_.data());
    packRanges(around.cells.data(), around.cells.data() + around.cells.size(), cellY_.data(), y_.data());
    packRanges(around.cells.data(), around.cells.data() + around.cells.size(), cellZ_.data(), z_.data());
    packRanges(around.cells.data(), around.cells.data() + around.cells.size(), cellVolume_.data(), volume_.data());
    volume_.segment(around.count, padded - around.count).setZero();
    charge_.head(padded).setZero();
    loaded_ = padded;
}

void CloudDeposit::addCloud(const CloudSources& sources, Index row, bool normalise)
{
    cloud_.head(loaded_).setZero();
    const auto add = exponent_ == 1 ? addWeights1 : addWeights2;
    const double inverseSquare = 1.0 / (radius_ * radius_);
    Cloud c{sources.position(row, 0), sources.position(row, 1), sources.position(row, 2), inverseSquare, 1.0};
    const Index blocks = loaded_ / blockSize;
    double total = add(c, blocks, x_.data(), y_.data(), z_.data(), volume_.data(), cloud_.data());
    for (auto n = static_cast<std::size_t>(sources.firstImage[static_cast<std::size_t>(row)]);
         n < static_cast<std::size_t>(sources.firstImage[static_cast<std::size_t>(row) + 1]); ++n) {
        const Image& image = sources.images[n];
        c = {image.position[0], image.position[1], image.position[2], inverseSquare, image.sign};
        total += add(c, blocks, x_.data(), y_.data(), z_.data(), volume_.data(), cloud_.data());
    }
    const double scale = normalise ? (total > 0 ? 1.0 / total : 0.0) : amplitude_;
    charge_.head(loaded_) += sources.charge[row] * scale * cloud_.head(loaded_);
}

void CloudDeposit::addCloudWithoutMoment(const CloudSources& sources, Index row, Index cells)
{
    const auto r = static_cast<std::size_t>(row);
    const double inverse = 1.0 / radius_;
    samples_.clear();
    Eigen::Matrix4d moments = Eigen::Matrix4d::Zero();
    const auto addSource = [&](const Vector3& centre, const Image* image) {
        for (Index n = 0; n < cells; ++n) {
            Vector3 offset = inverse * (Vector3(x_[n], y_[n], z_[n]) - centre);
            const double m = 1 - offset.squaredNorm();
            if (m <= 0) {
                continue;
            }
            if (image) {
                offset = image->mirroredBack(offset, table_.planes());
            }
            const double weight = volume_[n] * (exponent_ == 1 ? m : m * m);
            samples_.push_back({n, weight, image ? image->sign : 1.0, offset});
            const Eigen::Vector4d basis(1, offset[0], offset[1], offset[2]);
            moments += weight * basis * basis.transpose();
        }
    };
    addSource(sources.position.row(row).matrix().transpose(), nullptr);
    for (auto n = static_cast<std::size_t>(sources.firstImage[r]);
         n < static_cast<std::size_t>(sources.firstImage[r + 1]); ++n) {
        addSource(sources.images[n].position, &sources.images[n]);
    }
    const Eigen::Vector4d factor = moments.ldlt().solve(Eigen::Vector4d::UnitX());
    for (const Sample& sample : samples_) {
        charge_[sample.cell] +=
            sources.charge[row] * sample.sign * sample.weight * (factor[0] + factor.tail<3>().dot(sample.offset));
    }
}

void CloudDeposit::add(const CloudSources& sources, Index row, const Surroundings& around)
{
    if (around.inexactWall && !around.wallWithoutImage) {
        addCloudWithoutMoment(sources, row, around.count);
    } else {
        addCloud(sources, row, !around.wallWithoutImage);
    }
}

void CloudDeposit::depositOne(const CloudSources& sources, Index row, Scalars& charge)
{
    const Surroundings& around = table_.of(sources.cell[static_cast<std::size_t>(row)]);
    loadCells(around);
    add(sources, row, around);
    charge = charge_.head(around.count);
}

/// False where neither the cloud of a copied charge nor an image's can give anything to a cell of this rank.
bool CloudDeposit::reachesOwn(const CloudSources& sources, Index row, const Surroundings& around) const
{
    const auto r = static_cast<std::size_t>(row);
    return sources.firstImage[r + 1] > sources.firstImage[r]
           || around.ownCentres.squaredDistance(sources.position.row(row).matrix().transpose()) < radius_ * radius_;
}

void CloudDeposit::deposit(const CloudSources& sources, Scalars& cellCharge)
{
    cellCharge.setZero(mesh_.ownCells);
    Index row = 0;
    while (row < sources.size()) {
        const std::int32_t host = sources.cell[static_cast<std::size_t>(row)];
        const Surroundings& around = table_.of(host);
        const Index first = row;
        while (row < sources.size() && sources.cell[static_cast<std::size_t>(row)] == host) {
            ++row;
        }
        if (around.ownCentres.empty()) {
            continue;  // copies too far away
        }
        loadCells(around);
        for (Index one = first; one < row; ++one) {
            if (host < mesh_.ownCells || reachesOwn(sources, one, around)) {
                add(sources, one, around);
            }
        }
        const double* charge = charge_.data();
        for (const RowRange& range : around.cells) {
            const Index own = std::min(range.end, mesh_.ownCells);
            for (Index cell = range.begin; cell < own; ++cell) {
                cellCharge[cell] += charge[cell - range.begin];
            }
            charge += range.end - range.begin;
        }
    }
}

}  // namespace him
