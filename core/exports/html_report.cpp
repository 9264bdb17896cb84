#include "exports/html_report.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <numeric>

namespace vitruvian {
namespace {

constexpr double kPixelsPerMetre = 420;

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string pixels(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  for (char& c : text) {
    if (c == ',') c = '.';
  }
  return text;
}

/// Parallel view of the body: across (to the picture's right), up, towards the viewer.
struct View {
  const char* name;
  Vec3d across, towards;
};

class Picture {
 public:
  Picture(const ReportContent& content, const View& view) : content_(content), view_(view) {
    const Eigen::RowVectorXd across = view.across.transpose() * content.vertices;
    left_ = across.minCoeff();
    top_ = content.vertices.row(1).maxCoeff();
    width_ = across.maxCoeff() - left_;
    height_ = top_ - content.vertices.row(1).minCoeff();
  }

  std::string svg() const {
    const double margin = 8;
    std::string out = "<figure><svg viewBox=\"" + pixels(-margin) + " " + pixels(-margin) + " " +
                      pixels(width_ * kPixelsPerMetre + 2 * margin) + " " +
                      pixels(height_ * kPixelsPerMetre + 2 * margin) + "\" role=\"img\" aria-label=\"" +
                      view_.name + "\">";
    out += body();
    for (const ReportCurve& curve : content_.curves) {
      out += "<polyline class=\"tape\" points=\"";
      for (const Vec3d& p : curve.course) out += place(p) + " ";
      out += "\"><title>" + escaped(curve.name) + "</title></polyline>";
    }
    return out + "</svg><figcaption>" + view_.name + "</figcaption></figure>";
  }

 private:
  std::string place(const Vec3d& p) const {
    return pixels((view_.across.dot(p) - left_) * kPixelsPerMetre) + "," +
           pixels((top_ - p.y()) * kPixelsPerMetre);
  }

  /// Triangles that face the viewer, farthest first, in 16 greys.
  std::string body() const {
    std::vector<int> order;
    std::vector<double> depth(static_cast<std::size_t>(content_.faces.cols()));
    std::vector<int> grey(depth.size());
    for (Index f = 0; f < content_.faces.cols(); ++f) {
      const Vec3d a = content_.vertices.col(content_.faces(0, f)),
                  b = content_.vertices.col(content_.faces(1, f)),
                  c = content_.vertices.col(content_.faces(2, f));
      const Vec3d normal = (b - a).cross(c - a).normalized();
      const double facing = normal.dot(view_.towards);
      if (!(facing > 0)) continue;
      const auto i = static_cast<std::size_t>(f);
      depth[i] = view_.towards.dot(a + b + c);
      grey[i] =
          std::clamp(static_cast<int>(16 * (0.55 * facing + 0.35 * std::max(0.0, normal.y()) + 0.2)), 4, 15);
      order.push_back(static_cast<int>(f));
    }
    std::sort(order.begin(), order.end(), [&](int a, int b) {
      const double da = depth[static_cast<std::size_t>(a)], db = depth[static_cast<std::size_t>(b)];
      return da < db || (da == db && a < b);
    });
    std::string out;
    for (const int f : order) {
      const char digit = "0123456789abcdef"[grey[static_cast<std::size_t>(f)]];
      const std::string colour{'#', digit, digit, digit};
      out += "<path fill=\"" + colour + "\" stroke=\"" + colour + "\" d=\"M";
      for (int k = 0; k < 3; ++k) out += place(content_.vertices.col(content_.faces(k, f))) + " ";
      out += "z\"/>";
    }
    return out;
  }

  const ReportContent& content_;
  const View& view_;
  double left_, top_, width_, height_;
};

std::string table(const char* caption, const std::vector<ReportRow>& rows) {
  std::string out = std::string("<h2>") + caption +
                    "</h2><table><thead><tr><th>Name<th>Value<th>±<th>Standard<th>"
                    "Definition</tr></thead><tbody>";
  for (const ReportRow& row : rows) {
    out += "<tr><td>" + escaped(row.name) + "<td class=\"n\">" + escaped(row.value) + "<td class=\"n\">" +
           escaped(row.uncertainty) + "<td>" + escaped(row.standard) + "<td>" + escaped(row.definition) +
           "</tr>\n";
  }
  return out + "</tbody></table>\n";
}

}  // namespace

std::string to_html_report(const ReportContent& content) {
  std::string out =
      "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>" + escaped(content.title) +
      "</title><style>body{font:14px/1.45 sans-serif;margin:2em auto;max-width:60em;padding:0 1em;color:#222}"
      "table{border-collapse:collapse;width:100%;font-size:12px}th,td{text-align:left;padding:2px "
      "8px;border-bottom:"
      "1px solid "
      "#ddd;vertical-align:top}.n{text-align:right;white-space:nowrap}figure{display:inline-block;width:45%;"
      "margin:0 "
      "2%;text-align:center}svg{width:100%;height:34em}.tape{fill:none;stroke:#c2185b;stroke-width:1.4}"
      "path{stroke-width:.4}tr{break-inside:avoid}</style>\n<h1>" +
      escaped(content.title) + "</h1>\n<p><b>" + escaped(content.verdict) + "</b></p>\n<ul>";
  for (const std::string& fact : content.facts) out += "<li>" + escaped(fact) + "</li>";
  out += "</ul>\n";
  for (const View& view :
       {View{"front", Vec3d::UnitX(), Vec3d::UnitZ()}, View{"left", -Vec3d::UnitZ(), Vec3d::UnitX()}}) {
    out += Picture(content, view).svg() + "\n";
  }
  out += table("Dimensions, millimetres", content.dimensions);
  out += table("Segments", content.segments);
  out += "<p>± is the standard uncertainty. Not a medical device.</p></html>\n";
  return out;
}

}  // namespace vitruvian
