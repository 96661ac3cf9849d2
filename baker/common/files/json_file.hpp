// json_file.hpp  A JSON file that knows on which line each of its keys stands.
#pragma once
#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace sinew::baker {

struct JsonFile {
  std::string path;
  nlohmann::json json;
  // Lines from 1, by place: ".rods[0].root" is where that key stands, ".rods[0]" where that value begins.
  std::map<std::string, size_t> line_of;
};

// Comments are allowed. Throws BadInput: the file cannot be read, or "PATH:LINE:COLUMN: not JSON: ...".
JsonFile read_json_file(const std::string& path);

}  // namespace sinew::baker
