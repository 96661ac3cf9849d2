// film_set.hpp  The camera, the floor and the scale of colours that all pictures of a run share, and its
// panels.
#pragma once
#include <vector>

#include "baker/render/picture/layout.hpp"
#include "baker/render/renderer.hpp"
#include "samples/demo/simulate.hpp"

namespace sinew::demo {

struct PanelSize {
  int width = 220, height = 260, samples = 4;
};

// Where the colours of displacement end, a share of the height: in every run, so that pictures of two
// compare.
inline constexpr double kDarkest = 0.05;

class FilmSet {
 public:
  // other: the same character's run beside it, with as many snapshots; null: none.
  FilmSet(const CharacterFile& character, const Run& run, const Run* other, const std::string& view,
          float aspect);

  // Of the snapshot of this index. With a truth: skinning, Sinew, truth, then the errors of the first two as
  // colour, then the errors over time. With another run: skinning and both, then how far they are apart and
  // how far tissue has moved in each, as colour. With neither: skinning, Sinew, how far tissue has moved.
  std::vector<render::Panel> panels(size_t snapshot, const PanelSize& size) const;
  // The snapshot of [first, end) where there is most to see.
  size_t liveliest(size_t first, size_t end) const;
  // In the order in which they play.
  std::string motions() const;
  // What the colours of displacement mean.
  std::string scale() const;

 private:
  using Positions = std::vector<Eigen::Vector3f>;
  struct Scale {
    std::string title, high;
    double highest_mm;
  };

  void place_camera(const std::string& view, float aspect);
  void add_framed(const Snapshot& snapshot, std::span<const uint32_t> moved, Positions* points) const;
  std::vector<float> farthest_m() const;
  Positions on_floor(const Snapshot& snapshot, const Positions& positions) const;
  render::Image picture(const Snapshot& snapshot, const Positions& positions, const PanelSize& size) const;
  render::Image distances(const Snapshot& snapshot, const Positions& positions, const Positions& from,
                          const Scale& scale, const PanelSize& size) const;

  const CharacterFile& character_;
  const Run &run_, *other_;
  render::Mesh mesh_;
  std::vector<uint32_t> welded_;
  render::Camera camera_;
  render::RenderOptions options_;
  bool follow_ = false;  // it travels too far for one picture
  Scale displacement_, error_;
};

}  // namespace sinew::demo
