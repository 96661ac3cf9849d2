// help.hpp  --help of programs that take little else.
#pragma once
#include <cstdio>
#include <cstring>

namespace sinew::perf {

// Prints the text, and says so, where any argument asks for it.
inline bool gives_help(int count, char** arguments, const char* text) {
  for (int i = 1; i < count; ++i) {
    if (std::strcmp(arguments[i], "--help") != 0 && std::strcmp(arguments[i], "-h") != 0) continue;
    std::puts(text);
    return true;
  }
  return false;
}

}  // namespace sinew::perf
