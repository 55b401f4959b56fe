// Shaders that only tests use: tests/shaders/NAME, compiled at run time and added to the shared library once.
#pragma once

#include "tests/support.h"

namespace irad::test {

inline const char* shader(const char* name) {
  for (const std::string& known : gpu().shaders->names())
    if (known == name) return name;
  const std::filesystem::path root = sourceFolder();
  gpu().shaders->add(name, compileGlsl(root / "shaders", (root / "tests/shaders" / name).string()));
  return name;
}

}  // namespace irad::test
