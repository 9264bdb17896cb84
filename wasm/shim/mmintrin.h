// Emscripten has no <mmintrin.h>, which Eigen 3.4.0 includes before its SSE kernels.
#pragma once
#include <xmmintrin.h>
// Emscripten's clang claims to be GCC 4.2, for which Eigen would emit x86 inline assembly in pmin and pmax.
#ifdef EIGEN_COMP_GNUC
#undef EIGEN_COMP_GNUC
#define EIGEN_COMP_GNUC 63
#endif
