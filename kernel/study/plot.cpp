#include "study/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#ifdef DIATOM_PLPLOT
#include <plplot/plplot.h>
#endif

namespace diatom {

std::vector<ChartPoint> paretoFront(const std::vector<ChartPoint> &points)
{
   std::vector<ChartPoint> sorted = points;
   std::stable_sort(sorted.begin(), sorted.end(), [](const ChartPoint &a, const ChartPoint &b) {
      return a.x < b.x || (a.x == b.x && a.y < b.y);
   });
   std::vector<ChartPoint> front;
   for (const ChartPoint &point : sorted)
      if (front.empty() || point.y < front.back().y)
         front.push_back(point);
   return front;
}

#ifndef DIATOM_PLPLOT

bool canPlot() { return false; }

Status writePlot(const Chart &, const std::filesystem::path &file)
{
   return Error{ErrorCode::unsupported,
                fmt::format("{} was not drawn: this build has no PLplot; install libplplot-dev and "
                            "plplot-driver-cairo and build again",
                            file.string())};
}

#else

namespace {

/// Okabe and Ito's eight colours, told apart by the colour-blind too, after paper, ink, grid and front.
constexpr std::array<std::array<int, 3>, 12> kColors{{{255, 255, 255},
                                                      {30, 30, 30},
                                                      {222, 222, 222},
                                                      {172, 196, 232},
                                                      {0, 114, 178},
                                                      {213, 94, 0},
                                                      {0, 158, 115},
                                                      {204, 121, 167},
                                                      {86, 180, 233},
                                                      {230, 159, 0},
                                                      {120, 100, 60},
                                                      {90, 90, 90}}};
constexpr int kInk = 1, kGrid = 2, kFront = 3, kFirst = 4;
constexpr std::array<const char *, 8> kSymbols{"●", "■", "▲", "◆", "▼", "★", "○", "□"};
constexpr int kWidth = 900, kHeight = 600; // of the SVG in points; the PNG has twice as many pixels
constexpr int kPngScale = 2;
constexpr double kLeft = 0.09, kRight = 0.69, kBottom = 0.12, kTop = 0.91; // of the plotting area
constexpr double kLine = 0.042;                                            // of the legend's lines

/// '#' begins an escape in PLplot's texts.
std::string plain(const std::string &text)
{
   std::string out;
   for (const char c : text)
      out += c == '#' ? std::string("##") : std::string(1, c);
   return out;
}

std::string axisText(const ChartAxis &axis)
{
   return plain(axis.unit.empty() ? axis.title : axis.title + " (" + axis.unit + ")");
}

/// A coordinate as PLplot wants it; not finite when the axis cannot show it.
double placed(const ChartAxis &axis, double value)
{
   if (!axis.logarithmic)
      return value;
   return value > 0 ? std::log10(value) : std::numeric_limits<double>::quiet_NaN();
}

struct Range
{
   double low = std::numeric_limits<double>::infinity(), high = -low;

   void add(double value)
   {
      if (!std::isfinite(value))
         return;
      low = std::min(low, value);
      high = std::max(high, value);
   }
   /// Leaves room around the points; a logarithmic axis shows at least one whole decade.
   void widen(bool logarithmic)
   {
      if (!(low <= high))
         low = high = 0;
      const double least = logarithmic ? 1 : std::max(1e-12, 1e-3 * std::abs(high));
      const double missing = std::max(0.0, least - (high - low));
      const double margin = missing / 2 + 0.06 * std::max(least, high - low);
      low -= margin;
      high += margin;
   }
};

/// Draws one chart on the current stream.
class Drawing
{
public:
   explicit Drawing(const Chart &chart) : m_chart(chart)
   {
      for (const Series &series : chart.series)
         for (const ChartPoint &point : series.points)
            take(point);
      if (chart.marked)
         take(*chart.marked);
      if (chart.limit)
         m_y.add(placed(chart.y, *chart.limit));
      m_x.widen(chart.x.logarithmic);
      m_y.widen(chart.y.logarithmic);
   }

   void draw()
   {
      pladv(0);
      plvpor(kLeft, kRight, kBottom, kTop);
      plwind(m_x.low, m_x.high, m_y.low, m_y.high);
      frame();
      front();
      limit();
      for (std::size_t k = 0; k < m_chart.series.size(); ++k)
         series(k);
      mark();
      legend();
   }

private:
   struct Line
   {
      std::vector<double> x, y;
      std::vector<std::string> label;
   };

   void take(const ChartPoint &point)
   {
      const double x = placed(m_chart.x, point.x), y = placed(m_chart.y, point.y);
      if (!std::isfinite(x) || !std::isfinite(y))
         return;
      m_x.add(x);
      m_y.add(y);
   }

   Line lineOf(const std::vector<ChartPoint> &points) const
   {
      Line line;
      for (const ChartPoint &point : points) {
         const double x = placed(m_chart.x, point.x), y = placed(m_chart.y, point.y);
         if (!std::isfinite(x) || !std::isfinite(y))
            continue;
         line.x.push_back(x);
         line.y.push_back(y);
         line.label.push_back(point.label);
      }
      return line;
   }

   static void polyline(const Line &line)
   {
      if (line.x.size() > 1)
         plline(static_cast<PLINT>(line.x.size()), line.x.data(), line.y.data());
   }

   void text(double x, double y, double justify, const std::string &words) const
   {
      plptex(x, y, 1, 0, justify, plain(words).c_str());
   }

   void frame() const
   {
      const std::string x = m_chart.x.logarithmic ? "l" : "", y = m_chart.y.logarithmic ? "l" : "";
      plschr(0, 0.72);
      plwidth(0.5);
      plcol0(kGrid);
      plbox(("g" + x).c_str(), 0, 0, ("g" + y).c_str(), 0, 0);
      plcol0(kInk);
      plbox(("bcnst" + x).c_str(), 0, 0, ("bcnstv" + y).c_str(), 0, 0);
      pllab(axisText(m_chart.x).c_str(), axisText(m_chart.y).c_str(), "");
      plmtex("t", 1.2, 0, 0, plain(m_chart.title).c_str());
   }

   void front() const
   {
      plcol0(kFront);
      plwidth(11);
      polyline(lineOf(m_chart.front));
   }

   void limit() const
   {
      if (!m_chart.limit)
         return;
      const double y = placed(m_chart.y, *m_chart.limit);
      plcol0(kInk);
      plwidth(1);
      pllsty(2);
      pljoin(m_x.low, y, m_x.high, y);
      pllsty(1);
      plschr(0, 0.6);
      text(m_x.high - 0.01 * (m_x.high - m_x.low), y + 0.018 * (m_y.high - m_y.low), 1, m_chart.limitName);
   }

   static int colorOf(std::size_t k)
   {
      return kFirst + static_cast<int>(k % (kColors.size() - static_cast<std::size_t>(kFirst)));
   }

   /// Where colours begin anew, symbols move on by one, so that no two series look alike.
   static const char *symbolOf(std::size_t k)
   {
      const std::size_t colors = kColors.size() - static_cast<std::size_t>(kFirst);
      return kSymbols[(k + k / colors) % kSymbols.size()];
   }

   void series(std::size_t k) const
   {
      const Series &one = m_chart.series[k];
      const Line line = lineOf(one.points);
      plcol0(colorOf(k));
      plwidth(1.5);
      if (one.joined)
         polyline(line);
      plschr(0, 0.75);
      if (!line.x.empty())
         plstring(static_cast<PLINT>(line.x.size()), line.x.data(), line.y.data(), symbolOf(k));
      plschr(0, 0.55);
      for (std::size_t i = 0; i < line.x.size(); ++i)
         text(line.x[i] + 0.012 * (m_x.high - m_x.low), line.y[i] + 0.02 * (m_y.high - m_y.low), 0,
              line.label[i]);
   }

   void mark() const
   {
      if (!m_chart.marked)
         return;
      const Line line = lineOf({*m_chart.marked});
      if (line.x.empty())
         return;
      plcol0(kInk);
      plschr(0, 1.9);
      plstring(1, line.x.data(), line.y.data(), "○");
      plschr(0, 0.68);
      const bool right = line.x[0] < (m_x.low + m_x.high) / 2;
      text(line.x[0] + (right ? 0.022 : -0.022) * (m_x.high - m_x.low),
           line.y[0] - 0.035 * (m_y.high - m_y.low), right ? 0 : 1, m_chart.marked->label);
   }

   /// Right of the plotting area, one line an entry; many are set closer and smaller.
   void legend() const
   {
      const double entries = static_cast<double>(m_chart.series.size()) + (m_chart.front.empty() ? 0 : 1);
      const double scale = std::min(1.0, (kTop - 0.04) / (kLine * std::max(1.0, entries)));
      plvpor(0, 1, 0, 1);
      plwind(0, 1, 0, 1);
      double y = kTop - 0.02;
      const double x = kRight + 0.02;
      const auto entry = [&](int color, double width, bool joined, const char *symbol,
                             const std::string &words) {
         plcol0(color);
         plwidth(width);
         if (joined)
            pljoin(x, y, x + 0.035, y);
         const double middle = x + 0.0175;
         plschr(0, 0.75 * scale);
         if (symbol)
            plstring(1, &middle, &y, symbol);
         plcol0(kInk);
         plschr(0, 0.62 * scale);
         text(x + 0.045, y, 0, words);
         y -= kLine * scale;
      };
      for (std::size_t k = 0; k < m_chart.series.size(); ++k)
         entry(colorOf(k), 1.5, m_chart.series[k].joined, symbolOf(k), m_chart.series[k].name);
      if (!m_chart.front.empty())
         entry(kFront, 7, true, nullptr, m_chart.frontName);
   }

   const Chart &m_chart;
   Range m_x, m_y;
};

/// PLplot asks on the terminal for a device that it lacks, so that this is found out before.
bool hasDevice(const std::string &name)
{
   constexpr int kMost = 100;
   std::array<const char *, kMost> titles{}, names{};
   const char **title = titles.data(), **device = names.data();
   int count = kMost;
   plgDevs(&title, &device, &count);
   return std::any_of(names.begin(), names.begin() + std::clamp(count, 0, kMost),
                      [&](const char *one) { return one && name == one; });
}

} // namespace

bool canPlot() { return true; }

Status writePlot(const Chart &chart, const std::filesystem::path &file)
{
   const std::string suffix = file.extension().string();
   const bool png = suffix == ".png";
   if (!png && suffix != ".svg")
      return Error{ErrorCode::usage, fmt::format("{}: a plot is written as .svg or .png", file.string())};
   const char *device = png ? "pngcairo" : "svg";
   if (!hasDevice(device))
      return Error{ErrorCode::unsupported,
                   fmt::format("{} was not drawn: PLplot has no device {}; install plplot-driver-cairo",
                               file.string(), device)};
   // PLplot ends the process when it cannot open its file, so that this is found out before; beside the
   // target, renamed when whole.
   const std::filesystem::path part = file.string() + ".part";
   if (std::FILE *probe = std::fopen(part.c_str(), "wb"))
      std::fclose(probe);
   else
      return Error{ErrorCode::unwritable,
                   fmt::format("{} cannot be written; choose another folder", file.string())};
   std::array<PLINT, kColors.size()> red{}, green{}, blue{};
   for (std::size_t k = 0; k < kColors.size(); ++k) {
      red[k] = kColors[k][0];
      green[k] = kColors[k][1];
      blue[k] = kColors[k][2];
   }
   const int scale = png ? kPngScale : 1;
   plsdev(device);
   plsfnam(part.c_str());
   plspage(0, 0, kWidth * scale, kHeight * scale, 0, 0);
   plscmap0(red.data(), green.data(), blue.data(), static_cast<PLINT>(kColors.size()));
   plinit();
   Drawing(chart).draw();
   plend1();
   std::error_code failed;
   std::filesystem::rename(part, file, failed);
   if (failed)
      return Error{ErrorCode::unwritable,
                   fmt::format("{} cannot be written: {}", file.string(), failed.message())};
   return {};
}

#endif

} // namespace diatom
