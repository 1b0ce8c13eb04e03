// SPDX-License-Identifier: GPL-3.0-or-later
#include "directSolve/directSolver.H"

#include "electrostatics/constants.hpp"
#include "electrostatics/p3m/lattice_operator.hpp"

#include <algorithm>
#include <cmath>
#include <fftw3.h>

namespace him {

namespace {

/// Sizes, places and normals may differ by this share of a cell from those of a uniform box.
constexpr double uniformity = 1e-6;

/// The lattice that a mesh may be: cells per direction and their size.
struct Lattice {
    Vector3 lower, size;
    std::array<int, 3> count{};
    bool found = false;
};

double reduced(double value, MPI_Op operation, MPI_Comm communicator)
{
    MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, operation, communicator);
    return value;
}

/// Axis along which the normal stands, or -1.
int axisOf(const Vector3& normal)
{
    int axis = 0;
    const double largest = normal.cwiseAbs().maxCoeff(&axis);
    return largest > 1 - uniformity ? axis : -1;
}

/// Conductors on axis-parallel planes all round, nothing periodic.
bool isClosedBox(const MeshArrays& mesh)
{
    for (Index face = 0; face < mesh.boundary.size(); ++face) {
        if (mesh.boundary.condition[static_cast<std::size_t>(face)] != FaceCondition::conductor
            || axisOf(mesh.boundary.normal.row(face).matrix().transpose()) < 0) {
            return false;
        }
    }
    return mesh.coupled.shift.size() == 0 || (mesh.coupled.shift == 0).all();
}

Lattice latticeOf(const MeshArrays& mesh, MPI_Comm communicator)
{
    Lattice lattice;
    constexpr double huge = std::numeric_limits<double>::max();
    Vector3 lower = Vector3::Constant(huge);
    Vector3 upper = Vector3::Constant(-huge);
    Vector3 step = Vector3::Constant(huge);
    for (Index face = 0; face < mesh.boundary.size(); ++face) {
        const int axis = axisOf(mesh.boundary.normal.row(face).matrix().transpose());
        lower[axis] = std::min(lower[axis], mesh.boundary.centre(face, axis));
        upper[axis] = std::max(upper[axis], mesh.boundary.centre(face, axis));
        // Half a cell from wall to centre: serves where no two cells of a rank are neighbours in this direction.
        const auto cell = mesh.boundary.cell[static_cast<std::size_t>(face)];
        step[axis] = std::min(step[axis], 2 * std::abs(mesh.boundary.centre(face, axis) - mesh.centre(cell, axis)));
    }
    double smallest = huge;
    for (int axis = 0; axis < 3; ++axis) {
        lower[axis] = reduced(lower[axis], MPI_MIN, communicator);
        upper[axis] = reduced(upper[axis], MPI_MAX, communicator);
        step[axis] = reduced(step[axis], MPI_MIN, communicator);
        smallest = std::min(smallest, step[axis]);
    }
    if (!(smallest > 0) || smallest == huge) {
        return lattice;
    }
    double cells = 1;
    bool uniform = true;
    for (int axis = 0; axis < 3; ++axis) {
        const double count = std::round((upper[axis] - lower[axis]) / step[axis]);
        uniform = uniform && count >= 1 && std::abs((upper[axis] - lower[axis]) / step[axis] - count) < uniformity * count;
        lattice.count[static_cast<std::size_t>(axis)] = static_cast<int>(count);
        lattice.size[axis] = (upper[axis] - lower[axis]) / count;
        cells *= count;
    }
    lattice.lower = lower;
    lattice.found = uniform && reduced(static_cast<double>(mesh.cells()), MPI_SUM, communicator) == cells;
    return lattice;
}

/// Whether every wall face of this rank lies on a side of the box; others are baffles inside it.
bool wallsAreSides(const BoundaryFaces& faces, const Lattice& lattice)
{
    for (Index face = 0; face < faces.size(); ++face) {
        const Vector3 normal = faces.normal.row(face).matrix().transpose();
        const int axis = axisOf(normal);
        const double length = lattice.size[axis] * lattice.count[static_cast<std::size_t>(axis)];
        const double side = lattice.lower[axis] + (normal[axis] > 0 ? length : 0);
        if (std::abs(faces.centre(face, axis) - side) > 1e3 * uniformity * lattice.size[axis]) {
            return false;
        }
    }
    return true;
}

/// As many faces as a box of whole cells has: neighbours share one face, and all of them do. Collective.
bool facesAreComplete(const MeshArrays& mesh, const Lattice& lattice, MPI_Comm communicator)
{
    const auto [nx, ny, nz] = lattice.count;
    const double sides = 2.0 * (static_cast<double>(nx) * ny + static_cast<double>(ny) * nz + static_cast<double>(nz) * nx);
    const double inner = 2 * static_cast<double>(mesh.internal.size()) + static_cast<double>(mesh.coupled.size());
    return reduced(static_cast<double>(mesh.boundary.size()), MPI_SUM, communicator) == sides
           && reduced(inner, MPI_SUM, communicator) == 6.0 * nx * ny * nz - sides;
}

/// Place of every cell on the lattice, x fastest; empty when one of them does not fit.
std::vector<std::int32_t> placesOf(const MeshArrays& mesh, const Lattice& lattice)
{
    std::vector<std::int32_t> places;
    const double volume = lattice.size.prod();
    for (Index cell = 0; cell < mesh.cells(); ++cell) {
        std::array<int, 3> index{};
        bool fits = std::abs(mesh.volume[cell] - volume) < uniformity * volume;
        for (int axis = 0; axis < 3; ++axis) {
            const double at = (mesh.centre(cell, axis) - lattice.lower[axis]) / lattice.size[axis] - 0.5;
            index[static_cast<std::size_t>(axis)] = static_cast<int>(std::lround(at));
            fits = fits && std::abs(at - std::round(at)) < 1e3 * uniformity && at > -0.5
                   && at < lattice.count[static_cast<std::size_t>(axis)] - 0.5;
        }
        if (!fits) {
            return {};
        }
        places.push_back(index[0] + lattice.count[0] * (index[1] + lattice.count[1] * index[2]));
    }
    return places;
}

std::vector<double> symbols(int count, double size, double (*symbol)(double))
{
    std::vector<double> values;
    for (int n = 1; n <= count; ++n) {
        values.push_back(symbol(pi * n / count) / (size * size));
    }
    return values;
}

}  // namespace

struct directSolver::Transforms {
    explicit Transforms(const std::array<int, 3>& count)
        : values(fftw_alloc_real(static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1])
                                 * static_cast<std::size_t>(count[2])))
    {
        // Plans are estimated, not measured: measured ones differ from run to run in their round-off, and a continued run
        // must go on bit for bit.
        forward = fftw_plan_r2r_3d(count[2], count[1], count[0], values, values, FFTW_RODFT10, FFTW_RODFT10, FFTW_RODFT10,
                                   FFTW_ESTIMATE);
        back = fftw_plan_r2r_3d(count[2], count[1], count[0], values, values, FFTW_RODFT01, FFTW_RODFT01, FFTW_RODFT01,
                                FFTW_ESTIMATE);
    }
    ~Transforms()
    {
        fftw_destroy_plan(forward);
        fftw_destroy_plan(back);
        fftw_free(values);
    }
    Transforms(const Transforms&) = delete;
    Transforms& operator=(const Transforms&) = delete;

    double* values;
    fftw_plan forward, back;
};

std::unique_ptr<directSolver> directSolver::create(const MeshArrays& mesh, MPI_Comm communicator)
{
    if (reduced(isClosedBox(mesh) ? 1 : 0, MPI_MIN, communicator) == 0) {
        return nullptr;
    }
    const Lattice lattice = latticeOf(mesh, communicator);
    if (!lattice.found) {
        return nullptr;
    }
    std::vector<std::int32_t> places = placesOf(mesh, lattice);
    const bool fits = static_cast<Index>(places.size()) == mesh.cells() && wallsAreSides(mesh.boundary, lattice);
    if (!facesAreComplete(mesh, lattice, communicator) || reduced(fits ? 1 : 0, MPI_MIN, communicator) == 0) {
        return nullptr;
    }
    std::unique_ptr<directSolver> solver(new directSolver(lattice.count, lattice.size, std::move(places), communicator));
    std::vector<std::int32_t> all = solver->placeOfAll_;
    std::sort(all.begin(), all.end());
    const bool each = std::adjacent_find(all.begin(), all.end()) == all.end();
    return each ? std::move(solver) : nullptr;
}

directSolver::directSolver(const std::array<int, 3>& count, const Vector3& size, std::vector<std::int32_t> place,
                           MPI_Comm communicator)
    : count_(count), size_(size), communicator_(communicator), place_(std::move(place)),
      transforms_(std::make_unique<Transforms>(count))
{
    int ranks = 1;
    MPI_Comm_size(communicator, &ranks);
    countOfRank_.resize(static_cast<std::size_t>(ranks));
    startOfRank_.assign(static_cast<std::size_t>(ranks), 0);
    const int mine = static_cast<int>(place_.size());
    MPI_Allgather(&mine, 1, MPI_INT, countOfRank_.data(), 1, MPI_INT, communicator);
    for (std::size_t rank = 1; rank < countOfRank_.size(); ++rank) {
        startOfRank_[rank] = startOfRank_[rank - 1] + countOfRank_[rank - 1];
    }
    placeOfAll_.resize(static_cast<std::size_t>(cells()));
    received_.resize(static_cast<std::size_t>(cells()));
    MPI_Allgatherv(place_.data(), mine, MPI_INT32_T, placeOfAll_.data(), countOfRank_.data(), startOfRank_.data(), MPI_INT32_T,
                   communicator);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        finiteVolume_[axis] = symbols(count_[axis], size_[static_cast<Index>(axis)], secondDifferenceSymbol);
        matched_[axis] = symbols(count_[axis], size_[static_cast<Index>(axis)], matchedSymbol);
    }
}

directSolver::~directSolver() = default;

void directSolver::gather(const Scalars& source)
{
    double* values = transforms_->values;
    if (countOfRank_.size() == 1) {
        for (std::size_t cell = 0; cell < place_.size(); ++cell) {
            values[place_[cell]] = source[static_cast<Index>(cell)];
        }
        return;
    }
    MPI_Allgatherv(source.data(), static_cast<int>(source.size()), MPI_DOUBLE, received_.data(), countOfRank_.data(),
                   startOfRank_.data(), MPI_DOUBLE, communicator_);
    for (std::size_t n = 0; n < received_.size(); ++n) {
        values[placeOfAll_[n]] = received_[n];
    }
}

void directSolver::solve(const Scalars& source, Operator kind, Scalars& potential)
{
    gather(source);
    double* values = transforms_->values;
    fftw_execute(transforms_->forward);
    const auto& symbol = kind == Operator::matched ? matched_ : finiteVolume_;
    // FFTW leaves a factor of 2 N in every direction.
    const double scale = 1.0 / (8.0 * static_cast<double>(cells()) * size_.prod());
    for (int k = 0; k < count_[2]; ++k) {
        for (int j = 0; j < count_[1]; ++j) {
            double* row = values + static_cast<std::ptrdiff_t>(count_[0]) * (j + static_cast<std::ptrdiff_t>(count_[1]) * k);
            const double across = symbol[1][static_cast<std::size_t>(j)] + symbol[2][static_cast<std::size_t>(k)];
            for (int i = 0; i < count_[0]; ++i) {
                row[i] *= scale / (across + symbol[0][static_cast<std::size_t>(i)]);
            }
        }
    }
    fftw_execute(transforms_->back);
    potential.resize(static_cast<Index>(place_.size()));
    for (std::size_t cell = 0; cell < place_.size(); ++cell) {
        potential[static_cast<Index>(cell)] = values[place_[cell]];
    }
}

void directSolver::addBoundaryValues(const BoundaryFaces& faces, const Scalars& boundaryValue, Scalars& source) const
{
    for (Index face = 0; face < faces.size(); ++face) {
        const Vector3 normal = faces.normal.row(face).matrix().transpose().cwiseAbs();
        source[faces.cell[static_cast<std::size_t>(face)]] += faces.area[face] * boundaryValue[face] / (0.5 * normal.dot(size_));
    }
}

}  // namespace him
