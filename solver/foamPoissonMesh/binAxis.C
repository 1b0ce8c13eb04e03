// SPDX-License-Identifier: GPL-3.0-or-later
#include "foamPoissonMesh/binAxis.H"

#include <algorithm>
#include <cmath>

namespace him {

namespace {

/// Bins are equal when no edge is further from its place than this share of one.
constexpr double equality = 1e-6;

}  // namespace

binAxis::binAxis(std::vector<double> coordinates, double same) : sorted_(std::move(coordinates))
{
    std::sort(sorted_.begin(), sorted_.end());
    for (const double coordinate : sorted_) {
        if (edges_.empty() || coordinate - edges_.back() > same) {
            edges_.push_back(coordinate);
        }
    }
}

void binAxis::reduceTo(int bins)
{
    if (bins >= layers()) {
        return;
    }
    std::vector<double> chosen{edges_.front()};
    for (int n = 1; n < bins; ++n) {
        const double coordinate =
            sorted_[sorted_.size() * static_cast<std::size_t>(n) / static_cast<std::size_t>(bins)];
        if (coordinate > chosen.back()) {
            chosen.push_back(coordinate);
        }
    }
    if (edges_.back() > chosen.back()) {
        chosen.push_back(edges_.back());
    }
    edges_ = chosen;
}

void binAxis::finish()
{
    sorted_ = {};
    const double width = (edges_.back() - edges_.front()) / bins();
    bool equal = true;
    for (std::size_t n = 0; n < edges_.size(); ++n) {
        equal = equal && std::abs(edges_[n] - edges_.front() - static_cast<double>(n) * width) < equality * width;
    }
    width_ = equal ? width : 0;
}

int binAxis::bin(double coordinate) const
{
    if (width_ > 0) {
        const double at = std::floor((coordinate - edges_.front()) / width_);
        return static_cast<int>(std::min(std::max(at, 0.0), static_cast<double>(bins() - 1)));
    }
    const auto above = std::upper_bound(edges_.begin() + 1, edges_.end() - 1, coordinate);
    return static_cast<int>(above - edges_.begin()) - 1;
}

double binAxis::middle(int bin) const
{
    const auto n = static_cast<std::size_t>(bin);
    return 0.5 * (edges_[n] + edges_[n + 1]);
}

}  // namespace him
