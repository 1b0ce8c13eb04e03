// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/electricRegion.H"

#include "OSspecific.H"
#include "Pstream.H"
#include "polyMesh.H"

namespace him {

namespace {

/// Whether the master rank sees a mesh in constant/<region> of the case or of its first part. Collective.
bool hasMesh(const Foam::fileName& casePath, const Foam::word& region)
{
    const Foam::fileName mesh = ofRegion("constant", region) / Foam::polyMesh::meshSubDir;
    bool found = Foam::Pstream::master() && (Foam::isDir(casePath / mesh) || Foam::isDir(casePath / "processor0" / mesh));
    Foam::Pstream::scatter(found);
    return found;
}

}  // namespace

Foam::word electricRegion(const Foam::fileName& casePath)
{
    return hasMesh(casePath, "electric") ? Foam::word("electric") : Foam::polyMesh::defaultRegion;
}

Foam::fileName ofRegion(const Foam::fileName& folder, const Foam::word& region)
{
    return region == Foam::polyMesh::defaultRegion ? folder : folder / region;
}

bool hasElectricMesh(const Foam::fileName& casePath)
{
    return hasMesh(casePath, electricRegion(casePath));
}

}  // namespace him
