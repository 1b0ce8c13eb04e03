// Debian installs a one-line version of this header that does not compile. Pair styles need only these two members; the
// style itself is not in the package, so no object of this class exists and neither member is ever called.
#ifndef HIMFOAM_FIX_INSERT_STREAM_PREDEFINED_H
#define HIMFOAM_FIX_INSERT_STREAM_PREDEFINED_H

#include "fix.h"

namespace LAMMPS_NS {

class FixInsertStreamPredefined : public Fix {
public:
    bool has_inserted() const { return false; }
    void copy_history(int, int, double*) const {}
};

}  // namespace LAMMPS_NS

#endif
