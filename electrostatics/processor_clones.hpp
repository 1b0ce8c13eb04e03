// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// For functions whose loops the compiler vectorises: one binary serves every x86-64 processor, and the loader picks the
// widest version that the machine has.

#if defined(__x86_64__) && defined(__GNUC__)
#define HIM_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define HIM_CLONES
#endif
