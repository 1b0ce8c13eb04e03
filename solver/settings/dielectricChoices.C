// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/dielectricChoices.H"

#include "settings/caseSettings.H"

#include <sstream>

namespace him {

namespace {

/// "(a b)" as its two words; empty ones when there are not exactly two.
std::pair<std::string, std::string> twoWords(std::string text)
{
    for (char& c : text) {
        c = c == '(' || c == ')' ? ' ' : c;
    }
    std::istringstream stream(text);
    std::string first, second, third;
    stream >> first >> second >> third;
    return third.empty() && !second.empty() ? std::make_pair(first, second) : std::pair<std::string, std::string>();
}

insulatingWallChoice readWall(const std::string& name, checkedDictionary entries)
{
    insulatingWallChoice wall;
    wall.name = name;
    if (entries.has("faceZone") == entries.has("betweenZones")) {
        entries.written("faceZone");
        entries.written("betweenZones");
        entries.complain("faceZone", "an insulating wall needs faces of the mesh to carry its charge. Give either "
                                     "`faceZone <name>;` or `betweenZones (<cell zone> <cell zone>);`.");
    } else if (entries.has("faceZone")) {
        wall.faceZone = entries.written("faceZone");
    } else {
        wall.zones = twoWords(entries.written("betweenZones"));
        if (wall.zones.first.empty() || wall.zones.first == wall.zones.second) {
            entries.complain("betweenZones",
                             "found " + entries.written("betweenZones")
                                 + ", but two different cell zones are needed, as in (bed glass); one of "
                                   "them may be none.");
        }
    }
    entries.refuseUnknownEntries();
    return wall;
}

}  // namespace

dielectricChoices readDielectricChoices(checkedDictionary& properties, double gas)
{
    dielectricChoices choices;
    choices.gas = gas;
    checkedDictionary permittivity = properties.section("zonePermittivity", true);
    for (const Foam::word& zone : permittivity.contents().toc()) {
        choices.permittivity.emplace_back(zone, permittivity.positive(zone));
    }
    checkedDictionary walls = properties.section("insulatingWalls", true);
    for (const Foam::word& name : walls.contents().toc()) {
        if (name == noTransfer || name == groundedTarget || name == insulatingTarget) {
            walls.complain(
                name, "this word says something else of a wall in couplingProperties. Give the wall another name.");
        }
        choices.walls.push_back(readWall(name, walls.section(name)));
    }
    return choices;
}

}  // namespace him
