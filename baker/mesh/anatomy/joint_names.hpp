// joint_names.hpp  Joints found by an artist's names.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "baker/import/character/character.hpp"

namespace sinew::baker {

const std::string& joint_name(const Character& character, size_t joint);

// Names that tell bones apart: a bone's own, or any end of its path, "tail/tip" of "root/tail/tip". A part of
// a path that a sibling has, too, is numbered: "ear#1", "ear#2". A path that begins with / begins at a root.
class JointNames {
 public:
  explicit JointNames(const Character& character);  // which outlives it, unchanged

  // Whether the name, end of a path, or prefix* is the joint's.
  bool is_called(size_t joint, const std::string& name) const;
  // Its name, and where another bone has that, too, as much of the end of its path as no other one has.
  std::string unique(size_t joint) const;
  const std::string& path(size_t joint) const { return paths_[joint]; }

 private:
  const Character& character_;
  std::vector<std::string> paths_, plain_;  // numbered and not
  std::map<std::string, std::vector<size_t>> called_;
};

// For each joint, whether one of the names, ends of paths, or prefix*, is its. Throws BadInput for a name
// that no joint has, with the nearest one; `where` says who asks: "recipe: region 'belly'".
std::vector<bool> match_joints(const Character& character, const std::vector<std::string>& names,
                               const std::string& where);

// The one bone of that name. Throws BadInput for none, and for several with their paths.
size_t find_joint(const Character& character, const std::string& name, const std::string& where);

}  // namespace sinew::baker
