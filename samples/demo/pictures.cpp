// pictures.cpp  see pictures.hpp.
#include "samples/demo/pictures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "baker/common/bad_input.hpp"
#include "baker/common/files/kept_files.hpp"
#include "baker/common/progress.hpp"
#include "baker/render/picture/encode.hpp"
#include "samples/demo/crowd_picture.hpp"
#include "samples/demo/film_set.hpp"

namespace sinew::demo {
namespace {

constexpr int kColumns = 3;        // of panels in a frame
constexpr size_t kSheetTimes = 8;  // columns of the contact sheet
constexpr int kGifWidth = 540, kCellWidth = 220, kCellHeight = 260;

// Rows of three.
render::Image compose(const std::vector<render::Panel>& panels) {
  std::vector<render::Image> rows;
  for (size_t first = 0; first < panels.size(); first += kColumns) {
    rows.push_back(render::side_by_side(
        std::span(panels).subspan(first, std::min<size_t>(kColumns, panels.size() - first))));
  }
  return render::stack(rows);
}

// One of each of a few equal stretches of the run: evenly spaced ones might all fall on the same step of a
// walk.
std::vector<size_t> sheet_times(const FilmSet& set, size_t snapshots) {
  std::vector<size_t> out;
  const size_t count = std::min(kSheetTimes, snapshots);
  for (size_t i = 0; i < count; ++i)
    out.push_back(set.liveliest(i * snapshots / count, (i + 1) * snapshots / count));
  return out;
}

// A column from the panels that show the character; a row a kind of panel.
class ContactSheet {
 public:
  void add(double time_s, const std::vector<render::Panel>& panels) {
    char when[32];
    std::snprintf(when, sizeof when, "%.2f s", time_s);
    columns_.push_back({});
    for (const render::Panel& panel : panels) {
      if (panel.title.empty()) continue;
      const bool is_of = panel.title == "Displacement" && !panel.subtitle.empty();
      const std::string what = is_of ? panel.subtitle + ", moved" : panel.title;
      columns_.back().push_back({render::shrink(panel.image, kCellWidth, kCellHeight), when + ("  " + what)});
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
  std::vector<std::vector<render::Cell>> columns_;
};

// An earlier run must leave neither its film here nor its frames at this one's end.
void remove_old_film(const std::filesystem::path& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    const bool is_frame = name.starts_with("frame_") && name.ends_with(".png");
    if (!is_frame && name != "animation.mp4" && name != "animation.gif") continue;
    baker::refuse_over_kept(entry.path());
    std::filesystem::remove(entry.path());
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

void make_pictures(const Run& run, const Run* other, const CharacterFile& character, const Options& options) {
  const std::filesystem::path folder = options.frames;
  remove_old_film(folder);
  const FilmSet set(character, run, other, options.view,
                    static_cast<float>(options.width) / static_cast<float>(options.height));
  const PanelSize size{options.width, options.height, options.samples};
  const std::vector<size_t> times = sheet_times(set, run.snapshots.size());
  const bool film = options.picture_fps > 0;
  ContactSheet sheet;
  {
    baker::Progress progress("rendering", film ? run.snapshots.size() : times.size());
    size_t done = 0;
    for (size_t i = 0; i < run.snapshots.size(); ++i) {
      const bool on_sheet = std::find(times.begin(), times.end(), i) != times.end();
      if (!film && !on_sheet) continue;
      const std::vector<render::Panel> panels = set.panels(i, size);
      if (on_sheet) sheet.add(run.snapshots[i].time_s, panels);
      if (film) {
        char name[32];
        std::snprintf(name, sizeof name, "frame_%04zu.png", i);
        render::write_png(folder / name, compose(panels));
      }
      progress.update(++done);
    }
  }
  const std::string names = other == nullptr ? run.name : run.name + " and " + other->name;
  const std::string scale = options.truth.empty() ? "; displacement, " + set.scale() : "";
  render::write_png(folder / "contact_sheet.png", sheet.image(names + ": " + set.motions() + scale));
  const PanelSize large{options.width * 3 / 2, options.height * 3 / 2, (film ? 4 : 1) * options.samples};
  render::write_png(folder / "still.png", compose(set.panels(set.liveliest(0, run.snapshots.size()), large)));
  if (!run.crowd.empty()) render::write_png(folder / "crowd.png", crowd_picture(character, run, options));
  if (film) write_films(folder, options.fps / std::max(1.0, std::round(options.fps / options.picture_fps)));
  std::printf("\npictures in %s: contact_sheet.png, still.png%s\n", options.frames.c_str(),
              film ? ", frame_*.png, animation" : " (a film too: --picture-fps 15)");
}

}  // namespace sinew::demo
