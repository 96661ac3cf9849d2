// film_set.hpp  The camera, the floor and the scale of colours that all pictures of a run share, and its
// panels.
#pragma once
#include <vector>

#include "samples/demo/simulate.hpp"
#include "samples/render/layout.hpp"
#include "samples/render/renderer.hpp"

namespace sinew::demo {

struct PanelSize {
  int width = 360, height = 400, samples = 8;
};

class FilmSet {
 public:
  FilmSet(const CharacterFile& character, const Run& run, float aspect);

  // With a truth: skinning, Sinew, truth, then the errors of the first two as colour, then the errors over
  // time. Without: skinning, Sinew, then how far tissue has moved as colour.
  std::vector<render::Panel> panels(const Snapshot& snapshot, const PanelSize& size) const;
  // The snapshot where there is most to see.
  size_t liveliest() const;

 private:
  using Positions = std::vector<Eigen::Vector3f>;
  Positions on_floor(const Snapshot& snapshot, const Positions& positions) const;
  render::Image picture(const Snapshot& snapshot, const Positions& positions, const PanelSize& size) const;
  render::Image distances(const Snapshot& snapshot, const Positions& positions, const Positions& from,
                          const std::string& title, const PanelSize& size) const;

  const Run& run_;
  render::Mesh mesh_;
  std::vector<uint32_t> welded_;
  render::Camera camera_;
  render::RenderOptions options_;
  bool follow_ = false;  // the root travels too far for one picture
  double highest_mm_ = 1;
};

}  // namespace sinew::demo
