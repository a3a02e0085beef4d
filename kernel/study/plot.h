// Charts for people: points and lines on linear or logarithmic axes, as SVG or PNG. Drawn by PLplot; a build
// without it cannot draw and says so. The same chart gives the same bytes: nothing of the clock is in it.
#pragma once

#include "core/result.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace diatom {

struct ChartAxis
{
   std::string title;
   std::string unit; // "" = none
   bool logarithmic = false;
};

struct ChartPoint
{
   double x = 0, y = 0;
   std::string label; // beside the point; "" = none
};

struct Series
{
   std::string name; // in the legend
   std::vector<ChartPoint> points;
   bool joined = true; // by a line, in the order given
};

struct Chart
{
   std::string title;
   ChartAxis x, y;
   std::vector<Series> series;
   /// What nothing beats: the points of least y for their x, drawn as one pale broad line.
   std::vector<ChartPoint> front;
   std::string frontName;
   /// One point to look at, ringed and labelled.
   std::optional<ChartPoint> marked;
   /// A value of y to stay below, as a dashed line.
   std::optional<double> limit;
   std::string limitName;
};

/// Points with x <= all others of no greater y, by ascending x: the front of least cost and least error.
std::vector<ChartPoint> paretoFront(const std::vector<ChartPoint> &points);

/// Whether this build can draw.
bool canPlot();

/// Writes `file` by its suffix, .svg or .png. Points that a logarithmic axis cannot show are left out.
/// Errors: other suffix, cannot write, a build without PLplot. One thread in the whole process at a time: the
/// library's state is global.
Status writePlot(const Chart &chart, const std::filesystem::path &file);

} // namespace diatom
