// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/liggghts/wall_list.hpp"

#include "dem_coupling/liggghts/private_access.hpp"

#include "fix_mesh_surface.h"
#include "fix_wall_gran.h"
#include "lammps.h"
#include "modify.h"
#include "primitive_wall.h"

namespace him {

namespace primitives = LAMMPS_NS::PRIMITIVE_WALL_DEFINITIONS;

struct PrimitiveShape {
    using Member = primitives::WallType LAMMPS_NS::PrimitiveWall::*;
    friend Member memberOf(PrimitiveShape);
};
template struct PrivateMember<PrimitiveShape, &LAMMPS_NS::PrimitiveWall::wType>;

struct PrimitiveParameters {
    using Member = double* LAMMPS_NS::PrimitiveWall::*;
    friend Member memberOf(PrimitiveParameters);
};
template struct PrivateMember<PrimitiveParameters, &LAMMPS_NS::PrimitiveWall::param>;

namespace {

/// Geometry of "xplane c", ..., "xcylinder radius c1 c2", ...: the numbers are given in the order x, y, z of the remaining
/// axes.
ImageWall imageWallOf(const std::string& name, int shape, const double* parameters)
{
    ImageWall wall;
    wall.name = name;
    const int axis = shape % 3;
    wall.normal = Vector3::Unit(axis);
    if (shape < primitives::XCYLINDER) {
        wall.point[axis] = parameters[0];
    } else {
        wall.shape = ImageWall::Shape::cylinder;
        wall.radius = parameters[0];
        wall.point[axis == 0 ? 1 : 0] = parameters[1];
        wall.point[axis == 2 ? 1 : 2] = parameters[2];
    }
    return wall;
}

}  // namespace

std::vector<ListedWall> listWalls(LAMMPS_NS::LAMMPS* lmp)
{
    std::vector<ListedWall> walls;
    for (int i = 0; i < lmp->modify->nfix; ++i) {
        auto* fix = dynamic_cast<LAMMPS_NS::FixWallGran*>(lmp->modify->fix[i]);
        if (!fix) {
            continue;
        }
        const bool charging = fix->contact_match("cohesion", "charge") || fix->contact_match("cohesion", "charge/sjkr");
        if (fix->is_mesh_wall()) {
            for (int m = 0; m < fix->n_meshes(); ++m) {
                LAMMPS_NS::FixMeshSurface* mesh = fix->mesh_list()[m];
                walls.push_back({{mesh->id, "mesh", mesh->atomTypeWall(), charging}, mesh});
            }
        } else {
            const auto shape = fix->primitiveWall()->*memberOf(PrimitiveShape{});
            walls.push_back({{fix->id, primitives::wallString[shape], fix->atom_type_wall(), charging, true,
                              imageWallOf(fix->id, shape, fix->primitiveWall()->*memberOf(PrimitiveParameters{}))},
                             fix});
        }
    }
    return walls;
}

std::vector<Vector3> pointsOfMeshWall(LAMMPS_NS::LAMMPS* lmp, const std::string& name)
{
    std::vector<Vector3> points;
    auto* fix = dynamic_cast<LAMMPS_NS::FixMeshSurface*>(lmp->modify->find_fix_id(name.c_str()));
    if (fix) {
        LAMMPS_NS::TriMesh& mesh = *fix->triMesh();
        for (int facet = 0; facet < mesh.sizeLocal(); ++facet) {
            for (int corner = 0; corner < 3; ++corner) {
                double node[3];
                mesh.node(facet, corner, node);
                points.emplace_back(node);
            }
        }
    }
    return points;
}

}  // namespace him
