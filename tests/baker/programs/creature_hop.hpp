// creature_hop.hpp  A coarse creature and the ground truth of its hop, which no training saw.
#pragma once
#include <functional>
#include <string>

#include "tests/baker/common/temporary_folder.hpp"
#include "tests/baker/programs/bake.hpp"
#include "tests/baker/programs/fill_once.hpp"

namespace sinew::test {

inline const std::string kAssets = SINEW_SOURCE_DIR "/assets/";

// Made once, for the truth is the slow part: kept by a name and by the test's own source, its __FILE__.
struct CreatureHop {
  struct Def {
    std::string name, source;
    std::string recipe = "tissue.json";
    std::string seconds = "0.667";
    std::function<void(const CreatureHop&)> more = [](const CreatureHop&) {};  // what else lies there
  };

  TemporaryFolder folder;
  std::string glb = folder.file("c.glb"), truth = folder.file("t.safetensors"), pack = folder.file("c.sinew");
  std::string recipe, weights = kAssets + "weights/creature.safetensors";

  explicit CreatureHop(const Def& def) : recipe(kAssets + "creature/" + def.recipe) {
    fill_once(folder, def.name,
              {SINEW_BAKE, __FILE__, def.source, kAssets + "creature/creature.json", recipe, weights},
              [&] { make(def); });
  }

 private:
  void make(const Def& def) const {
    must(bake({"creature", kAssets + "creature/creature.json", "-o", glb, "--vertices", "800"}));
    must(bake({"character", glb, "--recipe", recipe, "--tissue", weights, "-o", pack}));
    must(bake({"truth", glb, "--recipe", recipe, "--motion", "clip:hop", "--seconds", def.seconds,
               "--positions", "-o", truth}));
    def.more(*this);
  }
};

}  // namespace sinew::test
