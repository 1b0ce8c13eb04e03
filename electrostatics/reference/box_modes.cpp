// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/constants.hpp"
#include "electrostatics/reference/box_sums.hpp"

#include <algorithm>
#include <cmath>

namespace him {

namespace {

/// Charges and targets are taken in blocks, so that their tables stay in the cache.
constexpr Index blockSize = 256;

/// Values and derivatives of the modes of each direction at one block of points.
class BlockTables {
public:
    BlockTables(const std::array<BoxAxis, 3>& axes, const std::array<Index, 3>& modes) : axes_(axes), modes_(modes) {}

    void fill(const Points& points, Index first, Index count)
    {
        for (std::size_t a = 0; a < 3; ++a) {
            axes_[a].evaluate(points.col(static_cast<Index>(a)).segment(first, count), modes_[a], value[a],
                              derivative[a]);
        }
    }

    std::array<Eigen::MatrixXd, 3> value, derivative;  ///< mode, point

private:
    const std::array<BoxAxis, 3>& axes_;
    std::array<Index, 3> modes_;
};

std::array<Index, 3> tableSizes(const std::vector<ModeLayer>& layers)
{
    std::array<Index, 3> modes{0, 0, static_cast<Index>(layers.size())};
    for (const ModeLayer& layer : layers) {
        modes[0] = std::max(modes[0], layer.x);
        modes[1] = std::max(modes[1], layer.y);
    }
    return modes;
}

/// sum over charges of q times the mode, one matrix (mode x, mode y) per mode along z.
std::vector<Eigen::MatrixXd> amplitudes(const BoxSum& sum, const std::vector<ModeLayer>& layers, BlockTables& tables)
{
    std::vector<Eigen::MatrixXd> amplitude;
    for (const ModeLayer& layer : layers) {
        amplitude.push_back(Eigen::MatrixXd::Zero(layer.x, layer.y));
    }
    Eigen::MatrixXd weighted;
    for (Index first = 0; first < sum.position.rows(); first += blockSize) {
        const Index count = std::min(blockSize, sum.position.rows() - first);
        tables.fill(sum.position, first, count);
        const auto charge = sum.charge.segment(first, count).matrix().transpose();
        for (std::size_t z = 0; z < layers.size(); ++z) {
            weighted = tables.value[1].topRows(layers[z].y)
                       * charge.cwiseProduct(tables.value[2].row(static_cast<Index>(z))).asDiagonal();
            amplitude[z].noalias() += tables.value[0].topRows(layers[z].x) * weighted.transpose();
        }
    }
    return amplitude;
}

/// Multiplies by what one mode of the charge adds to the potential: 4 pi exp(-k^2/4 alpha^2)/k^2. A uniform mode is dropped:
/// the background takes it.
void solve(const std::array<BoxAxis, 3>& axes, double alpha, std::vector<Eigen::MatrixXd>& amplitude)
{
    for (std::size_t z = 0; z < amplitude.size(); ++z) {
        for (Index y = 0; y < amplitude[z].cols(); ++y) {
            for (Index x = 0; x < amplitude[z].rows(); ++x) {
                const double square = std::pow(axes[0].waveNumber(x), 2) + std::pow(axes[1].waveNumber(y), 2)
                                      + std::pow(axes[2].waveNumber(static_cast<Index>(z)), 2);
                amplitude[z](x, y) *= square > 0 ? 4 * pi * std::exp(-square / (4 * alpha * alpha)) / square : 0;
            }
        }
    }
}

}  // namespace

std::vector<ModeLayer> modeLayers(const std::array<BoxAxis, 3>& axes, double largest)
{
    const auto square = [&](std::size_t axis, Index mode) { return std::pow(axes[axis].waveNumber(mode), 2); };
    const auto upTo = [&](std::size_t axis, double left) {
        return left < 0 ? Index{0} : axes[axis].modesUpTo(std::sqrt(left));
    };
    std::vector<ModeLayer> layers;
    for (Index z = 0; z < axes[2].modesUpTo(largest); ++z) {
        const double left = largest * largest - square(2, z);
        layers.push_back({upTo(0, left - square(1, 0)), upTo(1, left - square(0, 0))});
    }
    return layers;
}

void addModes(const BoxSum& sum, double alpha, double largestWaveNumber, Points& field, Scalars& potential)
{
    const std::vector<ModeLayer> layers = modeLayers(sum.axes, largestWaveNumber);
    if (layers.empty()) {
        return;
    }
    BlockTables tables(sum.axes, tableSizes(layers));
    std::vector<Eigen::MatrixXd> amplitude = amplitudes(sum, layers, tables);
    solve(sum.axes, alpha, amplitude);

    Eigen::MatrixXd valueX, slopeX;  // summed over the modes along x: mode y, point
    for (Index first = 0; first < sum.targets.rows(); first += blockSize) {
        const Index count = std::min(blockSize, sum.targets.rows() - first);
        tables.fill(sum.targets, first, count);
        auto blockField = field.middleRows(first, count);
        auto blockPotential = potential.segment(first, count);
        for (std::size_t z = 0; z < layers.size(); ++z) {
            const auto [x, y] = layers[z];
            valueX.noalias() = amplitude[z].transpose() * tables.value[0].topRows(x);
            slopeX.noalias() = amplitude[z].transpose() * tables.derivative[0].topRows(x);
            const auto valueY = tables.value[1].topRows(y);
            const auto slopeY = tables.derivative[1].topRows(y);
            const auto valueZ = tables.value[2].row(static_cast<Index>(z)).transpose().array();
            const auto slopeZ = tables.derivative[2].row(static_cast<Index>(z)).transpose().array();
            const Scalars inPlane = valueX.cwiseProduct(valueY).colwise().sum().transpose().array();
            blockPotential += inPlane * valueZ;
            blockField.col(0) -= slopeX.cwiseProduct(valueY).colwise().sum().transpose().array() * valueZ;
            blockField.col(1) -= valueX.cwiseProduct(slopeY).colwise().sum().transpose().array() * valueZ;
            blockField.col(2) -= inPlane * slopeZ;
        }
    }
}

}  // namespace him
