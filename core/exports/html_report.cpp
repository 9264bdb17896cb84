#include "exports/html_report.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "exports/markup.h"

namespace vitruvian {
namespace {

constexpr double kPixelsPerMetre = 420;

std::string pixels(double value) { return fixed_text(value, 1); }

/// Parallel view of the body: across (to the picture's right), up, towards the viewer.
struct View {
  const char* name;
  Vec3d across, towards;
};

class Picture {
 public:
  Picture(const ReportFigure& figure, const Faces& faces, const View& view)
      : figure_(figure), faces_(faces), view_(view) {
    const Eigen::RowVectorXd across = view.across.transpose() * figure.vertices;
    left_ = across.minCoeff();
    top_ = figure.vertices.row(1).maxCoeff();
    width_ = across.maxCoeff() - left_;
    height_ = top_ - figure.vertices.row(1).minCoeff();
  }

  std::string svg() const {
    const double margin = 8;
    std::string out = "<figure><svg viewBox=\"" + pixels(-margin) + " " + pixels(-margin) + " " +
                      pixels(width_ * kPixelsPerMetre + 2 * margin) + " " +
                      pixels(height_ * kPixelsPerMetre + 2 * margin) + "\" role=\"img\" aria-label=\"" +
                      escaped(figure_.name) + ", " + view_.name + "\">";
    out += body();
    for (const ReportCurve& curve : figure_.curves) {
      out += "<polyline class=\"tape\" points=\"";
      for (const Vec3d& p : curve.course) out += place(p) + " ";
      out += "\"><title>" + escaped(curve.name) + "</title></polyline>";
    }
    return out + "</svg><figcaption>" + escaped(figure_.name) + ", " + view_.name + "</figcaption></figure>";
  }

 private:
  std::string place(const Vec3d& p) const {
    return pixels((view_.across.dot(p) - left_) * kPixelsPerMetre) + "," +
           pixels((top_ - p.y()) * kPixelsPerMetre);
  }

  /// Triangles that face the viewer, farthest first, in 16 greys.
  std::string body() const {
    std::vector<int> order;
    std::vector<double> depth(static_cast<std::size_t>(faces_.cols()));
    std::vector<int> grey(depth.size());
    for (Index f = 0; f < faces_.cols(); ++f) {
      const Vec3d a = figure_.vertices.col(faces_(0, f)), b = figure_.vertices.col(faces_(1, f)),
                  c = figure_.vertices.col(faces_(2, f));
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
      for (int k = 0; k < 3; ++k) out += place(figure_.vertices.col(faces_(k, f))) + " ";
      out += "z\"/>";
    }
    return out;
  }

  const ReportFigure& figure_;
  const Faces& faces_;
  const View& view_;
  double left_, top_, width_, height_;
};

std::string table(const ReportTable& table) {
  std::string out = "<h2>" + escaped(table.heading) + "</h2>\n";
  if (!table.words.empty()) out += "<p>" + escaped(table.words) + "</p>\n";
  out += "<table><thead><tr><th>Name<th>Value<th>±<th>Standard<th>Definition</tr></thead><tbody>";
  for (const ReportRow& row : table.rows) {
    out += "<tr><td>" + escaped(row.name) + "<td class=\"n\">" + escaped(row.value) + "<td class=\"n\">" +
           escaped(row.uncertainty) + "<td>" + escaped(row.standard) + "<td>" + escaped(row.definition) +
           "</tr>\n";
  }
  return out + "</tbody></table>\n";
}

/// Of screen and paper: A4 or Letter, black on white, no picture, plot or row torn apart.
constexpr const char* kStyle =
    "@page{margin:14mm}"
    "body{font:14px/1.45 sans-serif;margin:2em auto;max-width:60em;padding:0 1em;color:#222;background:#fff}"
    "h2{break-after:avoid;margin-top:1.6em}"
    "table{border-collapse:collapse;width:100%;font-size:12px}"
    "th,td{text-align:left;padding:2px 8px;border-bottom:1px solid #ddd;vertical-align:top}"
    "th{background:#f3f3f3}.n{text-align:right;white-space:nowrap}"
    "tr,figure,.plot{break-inside:avoid}"
    "figure{display:inline-block;width:45%;margin:0 2%;text-align:center}"
    "figure svg{width:100%;height:32em}path{stroke-width:.4}"
    ".tape{fill:none;stroke:#c2185b;stroke-width:1.4}"
    ".plot{width:47%;margin:.6em 1%;font-size:9px}.plot .t{font-size:11px;font-weight:bold}"
    ".plot path{stroke-width:1.6}.plot .grid path{stroke:#ddd;stroke-width:.6}"
    "@media print{body{font-size:11px;margin:0;max-width:none;padding:0}table{font-size:9.5px}"
    "figure svg{height:24em}*{print-color-adjust:exact;-webkit-print-color-adjust:exact}}";

}  // namespace

std::string to_html_report(const ReportContent& content) {
  std::string out = "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>" +
                    escaped(content.title) + "</title><style>" + kStyle + "</style>\n<h1>" +
                    escaped(content.title) + "</h1>\n<p><b>" + escaped(content.verdict) + "</b></p>\n<ul>";
  for (const std::string& fact : content.facts) out += "<li>" + escaped(fact) + "</li>";
  out += "</ul>\n";
  for (const ReportFigure& figure : content.figures) {
    for (const View& view :
         {View{"front", Vec3d::UnitX(), Vec3d::UnitZ()}, View{"left", -Vec3d::UnitZ(), Vec3d::UnitX()}}) {
      out += Picture(figure, content.faces, view).svg() + "\n";
    }
  }
  std::string plots;
  for (const Plot& profile : content.profiles) plots += to_svg(profile) + "\n";
  if (!content.profiles.empty())
    out += "<h2>Profiles along segments, as scanned</h2>\n<div>" + plots + "</div>\n";
  for (const ReportTable& each : content.tables) out += table(each);
  for (const std::string& remark : content.remarks) out += "<p>" + escaped(remark) + "</p>\n";
  return out + "</html>\n";
}

}  // namespace vitruvian
