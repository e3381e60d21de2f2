/* Which sources the library was compiled from: the number that compiled/building.py worked out of them. */
#include "pixels.h"

EXPORT int stackloft_abi(void) { return STACKLOFT_ABI; }
