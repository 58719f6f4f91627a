// Marks functions that a graphics card may call too, where the compiler is one that makes code for both; elsewhere it means
// nothing.
#pragma once

#if defined(__CUDACC__)
#define FELDSPAR_HD __host__ __device__
#else
#define FELDSPAR_HD
#endif
