// layout.hpp  Pictures from pictures: panels side by side, contact sheets, a legend for colours.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "baker/render/picture/image.hpp"

namespace sinew::render {

struct Panel {
  Image image;
  std::string title, subtitle;  // drawn over the picture's top left corner
};

// Same heights are not needed; tops align.
Image side_by_side(std::span<const Panel> panels, int gap_px = 4);

// Below each other; left edges align.
Image stack(std::span<const Image> rows, int gap_px = 4);

struct Cell {
  Image image;
  std::string caption;  // under the picture
};

// Row after row; every cell as large as the largest picture. columns < 1: as square as it comes.
Image contact_sheet(std::span<const Cell> cells, int columns, const std::string& title = {});

struct Legend {
  std::string title{};  // with its unit: "error (mm)"
  double low = 0, high = 1;
  std::string low_text{}, high_text{};  // empty: the numbers
};

// A colour bar in the lower right corner.
void draw_legend(Image& image, const Legend& legend);

// "12.5", "0.031", "1200": three digits.
std::string short_number(double value);

}  // namespace sinew::render
