// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/postProcessingFile.H"

#include "OSspecific.H"
#include "Pstream.H"

namespace him {

std::ofstream openPostProcessing(const Foam::Time& runTime, const Foam::word& group, const Foam::word& file, int digits)
{
    std::ofstream opened;
    if (Foam::Pstream::master()) {
        const Foam::fileName folder = runTime.globalPath() / "postProcessing" / group / runTime.timeName();
        Foam::mkDir(folder);
        opened.open(folder / file);
        opened.precision(digits);
    }
    return opened;
}

}  // namespace him
