// record.hpp  What is measured, one number a line of CSV.
#pragma once
#include <cstdio>
#include <string>

namespace sinew::perf {

// What a number is of; zero or empty where a field says nothing.
struct Case {
  const char* group;    // the table it belongs to
  std::string subject;  // what ran
  unsigned vertices = 0, instances = 0, workers = 0;
};

inline void put_header() { std::puts("group,subject,vertices,instances,workers,quantity,value"); }

// The quantity carries its unit.
inline void put(const Case& of, const char* quantity, double value) {
  std::printf("%s,%s,%u,%u,%u,%s,%.6g\n", of.group, of.subject.c_str(), of.vertices, of.instances, of.workers,
              quantity, value);
  std::fflush(stdout);
}

}  // namespace sinew::perf
