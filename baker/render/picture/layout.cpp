// layout.cpp  see layout.hpp.
#include "baker/render/picture/layout.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "baker/render/picture/text.hpp"

namespace sinew::render {
namespace {

// Letters grow with the picture, so that a small panel is not covered by its title.
float letter_px(int width) { return std::clamp(static_cast<float>(width) / 38, 7.0f, 20.0f); }

void draw_titles(Image& image, const Panel& panel, float size) {
  const float margin = 1.2f * size;
  draw_text(image, margin, margin + size, panel.title, {.size_px = size, .weight = 1.4f});
  draw_text(image, margin, margin + 2.9f * size, panel.subtitle,
            {.size_px = 0.78f * size, .weight = 1.1f, .color = kPaleInk});
}

}  // namespace

std::string short_number(double value) {
  char text[32];
  if (std::abs(value) >= 999.5) {
    std::snprintf(text, sizeof text, "%.0f", value);
  } else {
    std::snprintf(text, sizeof text, "%.3g", value);
  }
  return text;
}

Image side_by_side(std::span<const Panel> panels, int gap_px) {
  int width = -gap_px, height = 0;
  for (const Panel& panel : panels) {
    width += panel.image.width + gap_px;
    height = std::max(height, panel.image.height);
  }
  Image out(std::max(width, 0), height);
  const float letter = letter_px(width / std::max(1, static_cast<int>(panels.size())));
  int left = 0;
  for (const Panel& panel : panels) {
    Image image = panel.image;
    draw_titles(image, panel, letter);
    paste(image, left, 0, out);
    left += image.width + gap_px;
  }
  return out;
}

Image stack(std::span<const Image> rows, int gap_px) {
  int width = 0, height = -gap_px;
  for (const Image& row : rows) {
    width = std::max(width, row.width);
    height += row.height + gap_px;
  }
  Image out(width, std::max(height, 0));
  int top = 0;
  for (const Image& row : rows) {
    paste(row, 0, top, out);
    top += row.height + gap_px;
  }
  return out;
}

Image contact_sheet(std::span<const Cell> cells, int columns, const std::string& title) {
  const int count = static_cast<int>(cells.size());
  if (columns < 1) columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count))));
  columns = std::clamp(columns, 1, std::max(1, count));
  int cell_width = 1, cell_height = 1;
  bool captions = false;
  for (const Cell& cell : cells) {
    cell_width = std::max(cell_width, cell.image.width);
    cell_height = std::max(cell_height, cell.image.height);
    captions = captions || !cell.caption.empty();
  }
  constexpr int kGap = 8, kCaption = 24, kTitle = 44;
  const TextStyle style{.size_px = 10, .color = kPaleInk};
  const int step_x = cell_width + kGap, step_y = cell_height + kGap + (captions ? kCaption : 0);
  const int top = kGap + (title.empty() ? 0 : kTitle), rows = (count + columns - 1) / columns;
  Image out(kGap + columns * step_x, top + rows * step_y, kPaper);
  if (!title.empty()) {
    const TextStyle large{.size_px = 15, .weight = 1.35f};
    draw_text(out, kGap + 4, kTitle - 12, cut_to(title, static_cast<float>(out.width - 3 * kGap), large),
              large);
  }
  for (int i = 0; i < count; ++i) {
    const Cell& cell = cells[static_cast<size_t>(i)];
    const int x = kGap + i % columns * step_x, y = top + i / columns * step_y;
    paste(cell.image, x, y, out);
    draw_text_centered(out, static_cast<float>(x) + 0.5f * static_cast<float>(cell_width),
                       static_cast<float>(y + cell_height + 17),
                       cut_to(cell.caption, static_cast<float>(cell_width), style), style);
  }
  return out;
}

void draw_legend(Image& image, const Legend& legend) {
  const float size = 0.78f * letter_px(image.width);
  const int bar_width = image.width * 2 / 5, bar_height = std::max(4, static_cast<int>(0.9f * size));
  const int margin = static_cast<int>(1.6f * size);
  const int left = image.width - margin - bar_width;
  const int top = image.height - margin - static_cast<int>(1.8f * size) - bar_height;
  fill_box(image, left - 1, top - 1, bar_width + 2, bar_height + 2, kPaleInk);
  for (int x = 0; x < bar_width; ++x) {
    const float t = static_cast<float>(x) / static_cast<float>(std::max(1, bar_width - 1));
    fill_box(image, left + x, top, 1, bar_height, srgb_from_linear(ramp(t)));
  }
  const auto right = static_cast<float>(left + bar_width), base = static_cast<float>(image.height - margin);
  const TextStyle style{.size_px = size, .weight = 1.2f};
  draw_text(image, static_cast<float>(left), base,
            legend.low_text.empty() ? short_number(legend.low) : legend.low_text, style);
  draw_text_right(image, right, base, legend.high_text.empty() ? short_number(legend.high) : legend.high_text,
                  style);
  draw_text_right(image, right, static_cast<float>(top) - 0.7f * size, legend.title, style);
}

}  // namespace sinew::render
