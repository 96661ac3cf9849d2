// error_chart.cpp  see error_chart.hpp.
#include "samples/demo/error_chart.hpp"

#include <algorithm>
#include <cmath>

#include "baker/render/picture/layout.hpp"
#include "baker/render/picture/lines.hpp"
#include "baker/render/picture/text.hpp"

namespace sinew::demo {
namespace {

using render::Image;
using render::RgbBytes;

constexpr RgbBytes kSkinning{196, 84, 40}, kSinew{28, 104, 168}, kGrid{222, 226, 232}, kAxis{150, 158, 170};

// 1, 2 or 5 x 10^n, so that about `wanted` steps fill the range.
double round_step(double range, double wanted) {
  const double rough = std::max(range, 1e-9) / wanted;
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  const double digit = rough / decade;
  return decade * (digit < 1.5 ? 1 : digit < 3.5 ? 2 : digit < 7.5 ? 5 : 10);
}

// Data to pixels.
struct Frame {
  float left, right, top, bottom;
  double seconds, highest_mm;
  Eigen::Vector2f at(double t_s, double mm) const {
    return {left + static_cast<float>(t_s / seconds) * (right - left),
            bottom - static_cast<float>(mm / highest_mm) * (bottom - top)};
  }
};

void draw_axes(Image& image, const Frame& frame, float letter) {
  const render::TextStyle style{.size_px = letter, .color = render::kPaleInk};
  const double step_mm = round_step(frame.highest_mm, 5);
  for (double mm = 0; mm <= frame.highest_mm * 1.0001; mm += step_mm) {
    const Eigen::Vector2f line[2] = {frame.at(0, mm), frame.at(frame.seconds, mm)};
    render::draw_polyline(image, line, 1, mm == 0 ? kAxis : kGrid);
    render::draw_text_right(image, frame.left - 0.6f * letter, line[0].y() + 0.5f * letter,
                            render::short_number(mm), style);
  }
  const double step_s = round_step(frame.seconds, 5);
  for (double t = 0; t <= frame.seconds * 1.0001; t += step_s) {
    render::draw_text_centered(image, frame.at(t, 0).x(), frame.bottom + 2.0f * letter,
                               render::short_number(t), style);
  }
  render::draw_text_right(image, frame.right, frame.bottom + 4.0f * letter, "time (s)", style);
}

template <class Get>
void draw_curve(Image& image, const Frame& frame, const std::vector<FrameRecord>& frames, const Get& get,
                RgbBytes color) {
  std::vector<Eigen::Vector2f> points;
  const size_t every = std::max<size_t>(1, frames.size() / 2000);
  for (size_t i = 0; i < frames.size(); i += every)
    points.push_back(frame.at(frames[i].time_s, static_cast<double>(get(frames[i]))));
  render::draw_polyline(image, points, 2.2f, color);
}

}  // namespace

Image error_chart(const std::vector<FrameRecord>& frames, double now_s, int width, int height) {
  Image image(width, height, render::kPaper);
  const float letter = std::clamp(static_cast<float>(width) / 45, 6.0f, 16.0f);
  float highest = 1e-3f;
  for (const FrameRecord& frame : frames)
    highest = std::max({highest, frame.error.skinning_mm, frame.error.sinew_mm});
  const Frame frame{.left = 5 * letter,
                    .right = static_cast<float>(width) - 2.5f * letter,
                    .top = 9 * letter,
                    .bottom = static_cast<float>(height) - 6 * letter,
                    .seconds = std::max(1e-6, frames.back().time_s),
                    .highest_mm = static_cast<double>(1.05f * highest)};
  draw_axes(image, frame, letter);
  const Eigen::Vector2f mark[2] = {frame.at(now_s, 0), frame.at(now_s, frame.highest_mm)};
  render::draw_polyline(image, mark, 1.2f, kAxis);
  draw_curve(
      image, frame, frames, [](const FrameRecord& f) { return f.error.skinning_mm; }, kSkinning);
  draw_curve(
      image, frame, frames, [](const FrameRecord& f) { return f.error.sinew_mm; }, kSinew);
  const float title = 1.35f * letter;
  render::draw_text(image, 1.6f * letter, 1.6f * letter + title, "Mean error of soft parts (mm)",
                    {.size_px = title, .weight = 1.4f});
  render::draw_text(image, frame.left, 6.2f * letter, "skinning alone",
                    {.size_px = letter, .weight = 1.4f, .color = kSkinning});
  render::draw_text(image, frame.left + 16 * letter, 6.2f * letter, "Sinew",
                    {.size_px = letter, .weight = 1.4f, .color = kSinew});
  return image;
}

}  // namespace sinew::demo
