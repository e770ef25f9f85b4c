/* The library of random numbers that every Windows since 7 has and wine before 9 lacks; the standard library of Rust seeds its
 * hash tables from it. For the check under wine only, never packed. */
#include <windows.h>
#include <ntsecapi.h>

__declspec(dllexport) BOOL WINAPI ProcessPrng(BYTE *data, SIZE_T size) { return RtlGenRandom(data, (ULONG)size); }
