// pictures.cpp  see pictures.hpp.
#include "samples/demo/pictures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "baker/common/bad_input.hpp"
#include "baker/common/progress.hpp"
#include "samples/demo/crowd_picture.hpp"
#include "samples/demo/film_set.hpp"
#include "samples/render/encode.hpp"

namespace sinew::demo {
namespace {

constexpr int kColumns = 3;        // of panels in a frame
constexpr size_t kSheetTimes = 8;  // columns of the contact sheet
constexpr int kGifWidth = 540;

// Rows of three.
render::Image compose(const std::vector<render::Panel>& panels) {
  std::vector<render::Image> rows;
  for (size_t first = 0; first < panels.size(); first += kColumns) {
    rows.push_back(render::side_by_side(
        std::span(panels).subspan(first, std::min<size_t>(kColumns, panels.size() - first))));
  }
  return render::stack(rows);
}

// Snapshots spread evenly over the run, the last included.
std::vector<size_t> sheet_times(size_t snapshots) {
  std::vector<size_t> out;
  const size_t count = std::min(kSheetTimes, snapshots);
  for (size_t i = 1; i <= count; ++i) out.push_back(i * snapshots / count - 1);
  return out;
}

class ContactSheet {
 public:
  ContactSheet(size_t snapshots) : times_(sheet_times(snapshots)) {}
  // A column from the panels that show the character; a row a kind of panel.
  void offer(size_t snapshot, double time_s, const std::vector<render::Panel>& panels) {
    if (std::find(times_.begin(), times_.end(), snapshot) == times_.end()) return;
    char when[32];
    std::snprintf(when, sizeof when, "%.2f s", time_s);
    columns_.push_back({});
    for (const render::Panel& panel : panels) {
      if (!panel.title.empty())
        columns_.back().push_back({render::shrink(panel.image, 220, 260), panel.title + "  " + when});
    }
  }
  render::Image image(const std::string& title) const {
    std::vector<render::Cell> cells;
    for (size_t row = 0; row < columns_.front().size(); ++row) {
      for (const auto& column : columns_) cells.push_back(column[row]);
    }
    return render::contact_sheet(cells, static_cast<int>(columns_.size()), title);
  }

 private:
  std::vector<size_t> times_;
  std::vector<std::vector<render::Cell>> columns_;
};

// An earlier, longer run must not leave its frames at this one's end.
void remove_old_frames(const std::filesystem::path& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    if (name.starts_with("frame_") && name.ends_with(".png")) std::filesystem::remove(entry.path());
  }
}

void write_films(const std::filesystem::path& folder, double fps) {
  const std::string pattern = folder / "frame_%04d.png";
  for (const auto& [name, width] : {std::pair{"animation.mp4", 0}, std::pair{"animation.gif", kGifWidth}}) {
    const std::string trouble = render::encode({pattern, fps, folder / name, width});
    if (trouble.empty()) continue;
    std::fprintf(stderr, "sinew-demo: %s\n", trouble.c_str());
    return;
  }
}

}  // namespace

void make_pictures(const Run& run, const CharacterFile& character, const Options& options) {
  const std::filesystem::path folder = options.frames;
  remove_old_frames(folder);
  const FilmSet set(character, run, static_cast<float>(options.width) / static_cast<float>(options.height));
  const PanelSize size{options.width, options.height, options.samples};
  ContactSheet sheet(run.snapshots.size());
  {
    baker::Progress progress("rendering", run.snapshots.size());
    for (size_t i = 0; i < run.snapshots.size(); ++i) {
      const std::vector<render::Panel> panels = set.panels(run.snapshots[i], size);
      char name[32];
      std::snprintf(name, sizeof name, "frame_%04zu.png", i);
      render::write_png(folder / name, compose(panels));
      sheet.offer(i, run.snapshots[i].time_s, panels);
      progress.update(i + 1);
    }
  }
  render::write_png(folder / "contact_sheet.png",
                    sheet.image(character.name() + ": " + run.snapshots.back().motion));
  const PanelSize large{options.width * 3 / 2, options.height * 3 / 2, 4 * options.samples};
  render::write_png(folder / "still.png", compose(set.panels(run.snapshots[set.liveliest()], large)));
  if (!run.crowd.empty()) render::write_png(folder / "crowd.png", crowd_picture(character, run, options));
  const auto every = std::max(1.0, std::round(options.fps / options.picture_fps));
  write_films(folder, options.fps / every);
  std::printf("\npictures in %s: contact_sheet.png, still.png, frame_*.png, animation\n",
              options.frames.c_str());
}

}  // namespace sinew::demo
