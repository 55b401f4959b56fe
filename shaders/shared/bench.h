// Push constants of what `irad bench` measures the machine with.
#ifndef IRAD_SHARED_BENCH_H
#define IRAD_SHARED_BENCH_H
#include "shared/types.h"
IRAD_BEGIN

struct CopyPush {
  Uvec4Array from;
  Uvec4Array to;
  uint count;  ///< of uvec4
  uint pad;
};

IRAD_END
#endif
