// json_section.hpp  Reads an object of a recipe key by key; every complaint names the file, the place and the
// key.
#pragma once
#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "baker/common/files/json_file.hpp"

namespace sinew::baker {

class JsonSection {
 public:
  // `place` says where in which file, as in `creature.json: body[3]`. Throws BadInput when `json` is not an
  // object.
  JsonSection(const nlohmann::json& json, std::string place);
  // The whole of a file, which outlives it: complaints name lines, as in `creature.json:12: body[3]`.
  explicit JsonSection(const JsonFile& file);

  bool has(const std::string& key);
  double number(const std::string& key, double otherwise, double low, double high);
  bool flag(const std::string& key, bool otherwise);
  std::string text(const std::string& key);  // must be there and not empty
  std::string text(const std::string& key, const std::string& otherwise);
  std::vector<std::string> texts(const std::string& key);                                // absent: none
  Eigen::VectorXd numbers(const std::string& key, long count, double low, double high);  // must be there
  std::vector<int> whole_numbers(const std::string& key, int low, int high);             // must be there
  Eigen::Vector3d vector3(const std::string& key, const Eigen::Vector3d& otherwise, double low, double high);
  Eigen::Vector3d color(const std::string& key);  // "#rrggbb"; 0 .. 1 each
  std::vector<Eigen::VectorXd> rows(const std::string& key, long count, double low,
                                    double high);             // absent: none
  std::vector<JsonSection> sections(const std::string& key);  // of a list; absent: none
  JsonSection section(const std::string& key);                // must be there

  void finish() const;  // throws BadInput for a key nobody asked for, with the nearest one that was
  [[noreturn]] void complain(const std::string& key, const std::string& what) const;

 private:
  const nlohmann::json* find(const std::string& key);
  const nlohmann::json& need(const std::string& key);

  JsonSection(const nlohmann::json& json, std::string place, const JsonFile* file);
  JsonSection inner(const nlohmann::json& json, const std::string& place) const;
  std::string where(const std::string& key) const;

  const nlohmann::json* json_;
  const JsonFile* file_ = nullptr;
  std::string place_;
  std::vector<std::string> known_;
};

}  // namespace sinew::baker
