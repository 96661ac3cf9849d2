// crowd.hpp  Many of one character in a world, each a little later in its clip than the one before.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "samples/demo/character_file.hpp"
#include "samples/demo/motion.hpp"
#include "sinew/sinew.hpp"

namespace sinew::perf {

class Crowd {
 public:
  // Throws baker::BadInput. An empty clip plays all of them in turn. By default nothing
  // sleeps.
  Crowd(const demo::CharacterFile& character, unsigned instances, const std::string& clip = "",
        const TaskHook& tasks = {}, float sleep_tolerance = 0);

  void pose();  // all instances, a frame later
  FrameReport step() { return world_.step(1.0f / 60); }
  void read(unsigned instance, Space space);  // positions or bind-space deltas, into surface()
  void read_normals(unsigned instance);
  const std::vector<float>& surface() const { return surface_; }
  const AssetInfo& info() const { return info_; }
  size_t state_bytes() const { return world_.state_bytes(instances_[0]); }

 private:
  World world_;
  AssetInfo info_;
  std::unique_ptr<demo::Motion> motion_;
  std::vector<InstanceId> instances_;
  std::vector<Matrix34> joints_;
  std::vector<float> surface_;
  unsigned frame_ = 0;
};

}  // namespace sinew::perf
