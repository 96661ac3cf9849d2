// chart.cpp  see chart.hpp.
#include "baker/trade/report/chart.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "baker/common/files/write_file.hpp"
#include "baker/render/picture/image.hpp"
#include "baker/render/picture/lines.hpp"
#include "baker/render/picture/text.hpp"
#include "baker/trade/report/labels.hpp"

namespace sinew::baker {
namespace {

using Point = Eigen::Vector2f;
using render::RgbBytes;

constexpr int kWidth = 1280, kHeight = 800;
constexpr float kLeft = 120, kRight = 1130, kTop = 90, kBottom = 690, kLetter = 13;
constexpr RgbBytes kTier{28, 104, 168}, kVariant{46, 139, 87}, kBaseline{196, 84, 40}, kGrid{222, 226, 232},
    kInk{38, 44, 54}, kPale{150, 158, 170};

float width_of(const std::string& words) { return render::text_width(words, {.size_px = kLetter}); }

// Both pictures are drawn by the same strokes, and a text is as wide in both.
class Paper {
 public:
  void line(const std::vector<Point>& points, float width, RgbBytes color) {
    render::draw_polyline(image_, points, width, color);
    std::string list;
    for (const Point& p : points) list += number(p.x()) + "," + number(p.y()) + " ";
    svg_ += "<polyline fill=\"none\" stroke=\"" + hex(color) + "\" stroke-width=\"" + number(width) +
            "\" points=\"" + list + "\"/>\n";
  }
  void dot(const Point& at, RgbBytes color, bool filled) {
    constexpr int kSides = 24;
    std::vector<Point> ring;
    for (int i = 0; i <= kSides; ++i) {
      const float turn = 6.2831853f * static_cast<float>(i) / kSides;
      ring.push_back(at + kDotRadius * Point(std::cos(turn), std::sin(turn)));
    }
    if (filled)
      for (float r = 1; r < kDotRadius; r += 1.5f)
        render::draw_polyline(image_, scaled(ring, at, r / kDotRadius), 2, color);
    render::draw_polyline(image_, ring, 2, color);
    svg_ += "<circle cx=\"" + number(at.x()) + "\" cy=\"" + number(at.y()) + "\" r=\"" + number(kDotRadius) +
            "\" stroke=\"" + hex(color) + "\" stroke-width=\"2\" fill=\"" + (filled ? hex(color) : "none") +
            "\"/>\n";
  }
  // anchor: "start", "middle" or "end" of the text lies at the point.
  void text(const Point& at, const std::string& words, const std::string& anchor, RgbBytes color = kInk) {
    const render::TextStyle style{.size_px = kLetter, .color = color};
    if (anchor == "start") render::draw_text(image_, at.x(), at.y(), words, style);
    if (anchor == "middle") render::draw_text_centered(image_, at.x(), at.y(), words, style);
    if (anchor == "end") render::draw_text_right(image_, at.x(), at.y(), words, style);
    svg_ += "<text x=\"" + number(at.x()) + "\" y=\"" + number(at.y()) + "\" text-anchor=\"" + anchor +
            "\" textLength=\"" + number(width_of(words)) + "\" lengthAdjust=\"spacingAndGlyphs\" fill=\"" +
            hex(color) + "\">" + escaped(words) + "</text>\n";
  }
  void write(const std::string& stem) const {
    render::write_png(stem + ".png", image_);
    write_file(stem + ".svg", std::string_view(head() + svg_ + "</svg>\n"));
  }

 private:
  static std::string number(float value) {
    char text[24];
    std::snprintf(text, sizeof text, "%.1f", static_cast<double>(value));
    return text;
  }
  static std::string hex(RgbBytes color) {
    char text[8];
    std::snprintf(text, sizeof text, "#%02x%02x%02x", color[0], color[1], color[2]);
    return text;
  }
  static std::string escaped(const std::string& words) {
    std::string out;
    for (const char c : words) out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : std::string(1, c);
    return out;
  }
  static std::vector<Point> scaled(std::vector<Point> ring, const Point& center, float by) {
    for (Point& p : ring) p = center + by * (p - center);
    return ring;
  }
  static std::string head() {
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + std::to_string(kWidth) + " " +
           std::to_string(kHeight) +
           "\" font-family=\"sans-serif\" font-size=\"17\">\n<rect width=\"100%\" height=\"100%\" "
           "fill=\"#fafbfc\"/>\n";
  }

  render::Image image_{kWidth, kHeight, render::kPaper};
  std::string svg_;
};

// Decades that hold all values, and where a value lies between two places.
struct Axis {
  double low, high;
  float from, to;
  float at(double value) const {
    const double share = std::log(value / low) / std::log(high / low);
    return from + static_cast<float>(share) * (to - from);
  }
};

Axis axis_of(std::vector<double> values, float from, float to) {
  const auto [low, high] = std::ranges::minmax(values);
  return {low / 1.25, high * 1.25, from, to};
}

std::string short_number(double value) {
  char text[24];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

std::vector<double> marks_of(const Axis& axis) {
  std::vector<double> out;
  for (double decade = 1e-6; decade < 1e7; decade *= 10)
    for (const double digit : {1.0, 2.0, 5.0})
      if (const double v = digit * decade; v >= axis.low && v <= axis.high) out.push_back(v);
  return out;
}

void draw_axes(Paper& paper, const Axis& x, const Axis& y) {
  for (const double v : marks_of(x)) {
    paper.line({{x.at(v), kTop}, {x.at(v), kBottom}}, 1, kGrid);
    paper.text({x.at(v), kBottom + 26}, short_number(v), "middle", kPale);
  }
  for (const double v : marks_of(y)) {
    paper.line({{kLeft, y.at(v)}, {kRight, y.at(v)}}, 1, kGrid);
    paper.text({kLeft - 10, y.at(v) + 5}, short_number(v), "end", kPale);
  }
  paper.line({{kLeft, kTop}, {kLeft, kBottom}, {kRight, kBottom}}, 1.5f, kPale);
  paper.text({(kLeft + kRight) / 2, kBottom + 62}, "mean step of one instance, warm cache (us, logarithmic)",
             "middle");
  paper.text({kLeft - 100, kTop - 18}, "mean error as a fraction of skinning's (logarithmic)", "start");
}

RgbBytes color_of(const Row& row) {
  return row.kind == "tier" ? kTier : row.kind == "variant" ? kVariant : kBaseline;
}

using Dot = std::pair<Point, const Row*>;

bool is_on_front(const Row& row) { return row.dominated_by.empty(); }

void draw_names(Paper& paper, const std::vector<Dot>& dots, std::span<const Point> front) {
  constexpr float kTall = 18, kAboveLine = 13.5f;  // of a name's box, and of that its baseline
  std::vector<Labelled> labels;
  for (const auto& [at, row] : dots) labels.push_back({at, {width_of(row->name), kTall}});
  const std::vector<LabelBox> boxes =
      place_labels(labels, front, {Point(kLeft, kTop), Point(kWidth - 8, kBottom)});
  for (size_t i = 0; i < dots.size(); ++i) {
    const auto& [at, row] = dots[i];
    const Point end = nearest(boxes[i], at), towards = end - at;
    if (towards.norm() >= kThreadFrom)
      paper.line({at + (kDotRadius + 2) * towards.normalized(), end}, 1, kPale);
    paper.text(boxes[i].min() + Point(0, kAboveLine), row->name, "start",
               is_on_front(*row) ? kInk : render::kPaleInk);
  }
}

std::vector<Point> front_of(std::vector<Dot> dots) {
  std::erase_if(dots, [](const Dot& dot) {
    const Row& row = *dot.second;
    return row.kind != "tier" || !is_on_front(row) || row.tier == Tier::kExtrapolate;
  });
  std::ranges::sort(dots, {}, [](const Dot& dot) { return dot.first.x(); });
  std::vector<Point> line;
  for (const Dot& dot : dots) line.push_back(dot.first);
  return line;
}

void draw_legend(Paper& paper) {
  const auto entry = [&](float x, RgbBytes color, bool filled, const char* words) {
    paper.dot({x, kHeight - 22}, color, filled);
    paper.text({x + 14, kHeight - 17}, words, "start");
  };
  entry(130, kTier, true, "tier on the front");
  entry(350, kTier, false, "tier, dominated");
  entry(700, kVariant, true, "baked otherwise");
  entry(910, kVariant, false, "the same, dominated");
}

}  // namespace

void write_chart(const std::string& stem, const Measured& measured) {
  std::vector<double> costs, ratios;
  for (const Row& row : measured.rows) {
    if (!row.costs()) continue;
    costs.push_back(std::max(row.warm.p50_us, 1e-3));
    ratios.push_back(std::max(row.error.ratio, 1e-6));
  }
  const Axis x = axis_of(costs, kLeft, kRight);
  Axis y = axis_of(ratios, kBottom, kTop);
  y.low /= 2;  // room for the names of those that lie near each other at the lower end
  Paper paper;
  draw_axes(paper, x, y);
  std::vector<Dot> dots;
  for (const Row& row : measured.rows)
    if (row.costs())
      dots.push_back({{x.at(std::max(row.warm.p50_us, 1e-3)), y.at(std::max(row.error.ratio, 1e-6))}, &row});
  const std::vector<Point> front = front_of(dots);
  paper.line(front, 2, kTier);
  for (const auto& [at, row] : dots) paper.dot(at, color_of(*row), is_on_front(*row));
  draw_names(paper, dots, front);
  paper.text({kLeft - 100, 36}, measured.character + " on " + measured.processor, "start");
  draw_legend(paper);
  paper.write(stem);
}

}  // namespace sinew::baker
