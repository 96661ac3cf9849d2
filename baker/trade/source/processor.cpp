// processor.cpp  see processor.hpp.
#include "baker/trade/source/processor.hpp"

#include <fstream>
#include <map>

namespace sinew::baker {
namespace {

// Of the first core.
std::map<std::string, std::string> told() {
  std::map<std::string, std::string> out;
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const size_t colon = line.find(": ");
    if (colon != std::string::npos)
      out.emplace(line.substr(0, line.find_last_not_of(" \t", colon - 1) + 1), line.substr(colon + 2));
  }
  return out;
}

}  // namespace

std::string processor_name() {
  const std::map<std::string, std::string> values = told();
  const auto value = [&](const char* key, const std::string& before) {
    const auto found = values.find(key);
    return found == values.end() ? std::string() : before + found->second;
  };
  const std::string name = value("model name", "") + value("cpu family", " family ") +
                           value("model", " model ") + value("CPU implementer", " implementer ") +
                           value("CPU part", " part ");
  return name.empty() ? "this machine" : name.substr(name.find_first_not_of(' '));
}

}  // namespace sinew::baker
