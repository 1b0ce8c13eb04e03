// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace him {

/// Access to a private member of a library class whose headers we may not change. Explicit template instantiation is
/// exempt from access checks ([temp.spec]/6), so the member pointer can be handed to a friend function:
///
///     struct FixMap { using Member = std::map<...>* LAMMPS_NS::Modify::*; friend Member memberOf(FixMap); };
///     template struct PrivateMember<FixMap, &LAMMPS_NS::Modify::fix_map>;
///     (*object).*memberOf(FixMap{})
///
/// The tag stands in namespace him itself, like memberOf.
template <typename Tag, typename Tag::Member pointer> struct PrivateMember {
    friend typename Tag::Member memberOf(Tag) { return pointer; }
};

}  // namespace him
