#include "report/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/text.h"
#include "report/markup.h"

namespace sphgeo {

namespace {

constexpr double font = 12.5;
constexpr double line_height = 18;
/// Mean width of a character by the size of the font; a little too wide, so that nothing overlaps.
constexpr double character = 0.56;

/// Legible on white and on near-black; a page may set its own colours.
constexpr std::array palette{"#2b74b8", "#cf5b22", "#2f9463", "#8d64b5",
                             "#a98612", "#c44d86", "#2499a6", "#7d7f86"};

struct Point {
  double x, y;
};

struct Rect {
  double x0, y0, x1, y1;
  bool meets(const Rect& b) const { return x0 < b.x1 && b.x0 < x1 && y0 < b.y1 && b.y0 < y1; }
};

/// Characters of UTF-8 text.
std::size_t letters(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

double text_width(const std::string& text, double size = font) {
  return character * size * static_cast<double>(letters(text));
}

bool drawable(double value, const ChartAxis& axis) {
  return std::isfinite(value) && (!axis.log || value > 0);
}

/// The extremes of what can be drawn; low > high when there is nothing.
struct Extent {
  double x0 = std::numeric_limits<double>::infinity(), x1 = -x0, y0 = x0, y1 = -x0;
  bool empty() const { return !(x0 <= x1 && y0 <= y1); }
};

Extent extent_of(const Chart& chart) {
  Extent e;
  for (const ChartCurve& c : chart.curves) {
    if (c.x.size() != c.y.size() || (!c.labels.empty() && c.labels.size() != c.x.size()))
      throw std::invalid_argument(fmt::format("curve '{}': {} x, {} y, {} labels", c.name,
                                              c.x.size(), c.y.size(), c.labels.size()));
    for (std::size_t i = 0; i < c.x.size(); ++i) {
      if (!drawable(c.x[i], chart.x) || !drawable(c.y[i], chart.y)) continue;
      e.x0 = std::min(e.x0, c.x[i]);
      e.x1 = std::max(e.x1, c.x[i]);
      e.y0 = std::min(e.y0, c.y[i]);
      e.y1 = std::max(e.y1, c.y[i]);
    }
  }
  return e;
}

/// Pieces of a curve between gaps.
std::vector<std::vector<Point>> pieces_of(const std::vector<Point>& points) {
  std::vector<std::vector<Point>> pieces(1);
  for (const Point& p : points) {
    if (std::isfinite(p.x) && std::isfinite(p.y)) pieces.back().push_back(p);
    else if (!pieces.back().empty()) pieces.emplace_back();
  }
  if (pieces.back().empty()) pieces.pop_back();
  return pieces;
}

/// Of the points in one column of the picture only the first, lowest, highest and last: the line
/// looks the same.
std::vector<Point> thinned(const std::vector<Point>& points) {
  if (points.size() < 600) return points;
  std::vector<Point> out;
  for (std::size_t i = 0; i < points.size();) {
    std::size_t end = i, low = i, high = i;
    for (; end < points.size() && std::floor(points[end].x) == std::floor(points[i].x); ++end) {
      if (points[end].y < points[low].y) low = end;
      if (points[end].y > points[high].y) high = end;
    }
    std::array keep{i, low, high, end - 1};
    std::sort(keep.begin(), keep.end());
    for (std::size_t k = 0; k < keep.size(); ++k)
      if (k == 0 || keep[k] != keep[k - 1]) out.push_back(points[keep[k]]);
    i = end;
  }
  return out;
}

class Drawing {
 public:
  explicit Drawing(const Chart& chart)
      : chart_(chart),
        extent_(extent_of(chart)),
        x_(chart.x, extent_.x0, extent_.x1, static_cast<int>(chart.width / 80)),
        y_(chart.y, extent_.y0, extent_.y1, static_cast<int>(chart.height / 50)) {
    double widest = 0;
    for (const double t : y_.ticks()) widest = std::max(widest, text_width(y_.text(t)));
    plot_ = {widest + 12 + (y_.title().empty() ? 0 : line_height),
             chart.title.empty() ? 12.0 : 30.0, chart.width - 14,
             chart.height - 26 - (x_.title().empty() ? 0 : line_height)};
  }

  std::string operator()() {
    axes();
    if (extent_.empty()) {
      text((plot_.x0 + plot_.x1) / 2, (plot_.y0 + plot_.y1) / 2, "no values", "middle",
           "opacity=\".6\"");
    } else {
      // A nested <svg> cuts off what lies outside of the plot; it needs no name that another chart
      // could have.
      body_ += fmt::format(
          "<svg x=\"{0:.1f}\" y=\"{1:.1f}\" width=\"{2:.1f}\" height=\"{3:.1f}\" viewBox=\"{0:.1f} "
          "{1:.1f} {2:.1f} {3:.1f}\">\n",
          plot_.x0, plot_.y0 - 4, plot_.x1 - plot_.x0 + 5, plot_.y1 - plot_.y0 + 8);
      int next = 0;
      for (const ChartCurve& c : chart_.curves) {
        colors_.push_back(c.neutral ? "currentColor" : color(c.color ? *c.color : next++));
        curve(c, colors_.back());
      }
      body_ += "</svg>\n";
      for (std::size_t i = 0; i < chart_.curves.size(); ++i) labels(chart_.curves[i], colors_[i]);
    }
    const double bottom = legend();
    return fmt::format(
        "<svg class=\"chart\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.0f} {:.0f}\" "
        "role=\"img\" "
        "aria-label=\"{}\" font-family=\"system-ui,-apple-system,'Segoe UI',Roboto,'Helvetica "
        "Neue',sans-serif\" "
        "font-size=\"{}\" fill=\"currentColor\" style=\"width:100%;height:auto\">\n{}</svg>\n",
        chart_.width, bottom, html_escaped(chart_.title.empty() ? y_.title() : chart_.title), font,
        body_);
  }

 private:
  static std::string color(int number) {
    const auto k = static_cast<std::size_t>(number < 0 ? 0 : number) % palette.size();
    return fmt::format("var(--curve-{},{})", k, palette[k]);
  }

  void text(double x, double y, const std::string& what, std::string_view anchor,
            std::string_view more = {}) {
    body_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}{}>{}</text>\n", x, y,
                         anchor, more.empty() ? "" : " ", more, html_escaped(what));
  }

  /// A text no wider than `room`.
  static std::string fitted(const std::string& what, double room) {
    const auto most = static_cast<std::size_t>(std::max(4.0, room / (character * font)));
    return letters(what) <= most ? what : shortened(what, most);
  }

  double px(double x) const { return plot_.x0 + x_.position(x) * (plot_.x1 - plot_.x0); }
  double py(double y) const { return plot_.y1 - y_.position(y) * (plot_.y1 - plot_.y0); }

  void axes() {
    std::string grid;
    for (const double t : y_.ticks())
      grid += fmt::format("M{:.1f} {:.1f}H{:.1f}", plot_.x0, py(t), plot_.x1);
    for (const double t : x_.ticks())
      grid += fmt::format("M{:.1f} {:.1f}V{:.1f}", px(t), plot_.y0, plot_.y1);
    body_ += fmt::format(
        "<path d=\"{}\" fill=\"none\" stroke=\"currentColor\" stroke-opacity=\".13\"/>\n", grid);
    body_ += fmt::format(
        "<path d=\"M{0:.1f} {1:.1f}V{2:.1f}H{3:.1f}\" fill=\"none\" stroke=\"currentColor\" "
        "stroke-opacity=\".55\"/>\n",
        plot_.x0, plot_.y0, plot_.y1, plot_.x1);
    body_ += "<g opacity=\".8\">\n";
    for (const double t : y_.ticks()) text(plot_.x0 - 6, py(t) + 0.35 * font, y_.text(t), "end");
    double free_from = -1e9;
    for (const double t : x_.ticks()) {
      const double half = text_width(x_.text(t)) / 2;
      if (px(t) - half < free_from) continue;
      text(px(t), plot_.y1 + 17, x_.text(t), "middle");
      free_from = px(t) + half + 6;
    }
    body_ += "</g>\n";
    if (!x_.title().empty())
      text((plot_.x0 + plot_.x1) / 2, plot_.y1 + 17 + line_height,
           fitted(x_.title(), plot_.x1 - plot_.x0), "middle");
    if (!y_.title().empty()) {
      const double middle = (plot_.y0 + plot_.y1) / 2;
      text(14, middle, fitted(y_.title(), plot_.y1 - plot_.y0), "middle",
           fmt::format("transform=\"rotate(-90 14 {:.1f})\"", middle));
    }
    if (!chart_.title.empty())
      text(4, 16, fitted(chart_.title, chart_.width - 8), "start", "font-weight=\"600\"");
  }

  static std::string stroke(const ChartCurve& c, const std::string& paint) {
    return fmt::format(
        "fill=\"none\" style=\"stroke:{}\" stroke-width=\"{}\" stroke-linejoin=\"round\" "
        "stroke-linecap=\"round\"{}",
        paint, c.emphasised ? 2.8 : 1.6, c.dashed ? " stroke-dasharray=\"5 4\"" : "");
  }

  static std::string marker(const ChartCurve& c, Point p) {
    // References are rings, so that a curve below them can be seen.
    return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>", p.x, p.y,
                       c.emphasised ? 4.4 : 3);
  }

  static std::string marker_style(const ChartCurve& c, const std::string& paint) {
    return c.neutral && !c.emphasised
               ? fmt::format("fill=\"none\" style=\"stroke:{}\" stroke-width=\"1.2\"", paint)
               : fmt::format("style=\"fill:{}\"", paint);
  }

  void curve(const ChartCurve& c, const std::string& paint) {
    std::vector<Point> points;
    for (std::size_t i = 0; i < c.x.size(); ++i) points.push_back({px(c.x[i]), py(c.y[i])});
    if (c.line) {
      std::string path;
      for (const auto& piece : pieces_of(points)) {
        const char* command = "M";
        for (const Point& p : thinned(piece)) {
          path += fmt::format("{}{:.1f} {:.1f}", command, p.x, p.y);
          command = "L";
        }
        if (piece.size() == 1) path += "h0";  // a lone sample: a dot by the round ends of the line
      }
      if (!path.empty()) body_ += fmt::format("<path d=\"{}\" {}/>\n", path, stroke(c, paint));
    }
    if (!c.markers) return;
    body_ += fmt::format("<g {}>", marker_style(c, paint));
    Point last{-1e9, -1e9};
    for (const Point& p : points) {
      // Dense measurements need no ring on ring.
      if (!std::isfinite(p.x) || !std::isfinite(p.y) ||
          (points.size() > 400 && std::hypot(p.x - last.x, p.y - last.y) < 2))
        continue;
      body_ += marker(c, p);
      last = p;
      taken_.push_back({p.x - 3, p.y - 3, p.x + 3, p.y + 3});
    }
    body_ += "</g>\n";
  }

  /// Texts beside points: at the first free side, else none.
  void labels(const ChartCurve& c, const std::string& paint) {
    constexpr double size = 11, away = 7;
    for (std::size_t i = 0; i < c.labels.size(); ++i) {
      const Point p{px(c.x[i]), py(c.y[i])};
      if (c.labels[i].empty() || !std::isfinite(p.x) || !std::isfinite(p.y)) continue;
      const double w = text_width(c.labels[i], size), h = size;
      for (const auto& [dx, dy, anchor] : {std::tuple{away, -away, "start"},
                                           {away, away + h, "start"},
                                           {-away, -away, "end"},
                                           {-away, away + h, "end"}}) {
        const double left = anchor == std::string_view("start") ? p.x + dx : p.x + dx - w;
        const Rect box{left, p.y + dy - h, left + w, p.y + dy};
        if (box.x0 < plot_.x0 || box.x1 > chart_.width || box.y0 < plot_.y0 - 12 ||
            box.y1 > plot_.y1)
          continue;
        if (std::any_of(taken_.begin(), taken_.end(), [&](const Rect& r) { return r.meets(box); }))
          continue;
        text(p.x + dx, p.y + dy - 2, c.labels[i], anchor,
             fmt::format("font-size=\"{}\" style=\"fill:{}\"", size, paint));
        taken_.push_back(box);
        break;
      }
    }
  }

  /// Rows of names below the axes; returns where the drawing ends.
  double legend() {
    const bool wanted = std::any_of(chart_.curves.begin(), chart_.curves.end(),
                                    [](const auto& c) { return !c.name.empty(); });
    if (!wanted || extent_.empty()) return chart_.height;
    constexpr double sample = 22, gap = 18;
    double x = plot_.x0, y = chart_.height + 10;
    for (std::size_t i = 0; i < chart_.curves.size(); ++i) {
      const ChartCurve& c = chart_.curves[i];
      if (c.name.empty()) continue;
      const std::string name = fitted(c.name, chart_.width - plot_.x0 - sample - 12);
      const double width = sample + 6 + text_width(name);
      if (x > plot_.x0 && x + width > chart_.width) {
        x = plot_.x0;
        y += line_height;
      }
      if (c.line)
        body_ += fmt::format("<path d=\"M{:.1f} {:.1f}h{}\" {}/>\n", x, y - 4, sample,
                             stroke(c, colors_[i]));
      if (c.markers)
        body_ += fmt::format("<g {}>{}</g>\n", marker_style(c, colors_[i]),
                             marker(c, {x + sample / 2, y - 4}));
      text(x + sample + 6, y, name, "start");
      x += width + gap;
    }
    return y + 10;
  }

  const Chart& chart_;
  Extent extent_;
  AxisScale x_, y_;
  Rect plot_{};
  std::string body_;
  std::vector<std::string> colors_;
  std::vector<Rect> taken_;  ///< where markers and labels stand
};

}  // namespace

std::string chart_svg(const Chart& chart) { return Drawing(chart)(); }

}  // namespace sphgeo
