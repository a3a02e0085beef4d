#include "equilibrium/supports.h"

#include <cmath>
#include <string>

namespace bonds {

using sdk::Failure;

double Curve::at(double t) const
{
   const auto next = std::upper_bound(time.begin(), time.end(), t) - time.begin();
   if (next == 0)
      return value.front();
   if (next == static_cast<std::ptrdiff_t>(time.size()))
      return value.back();
   const double f = (t - time[next - 1]) / (time[next] - time[next - 1]);
   return value[next - 1] + f * (value[next] - value[next - 1]);
}

Supports::Supports(const sdk::SceneView &scene, const Assembly &assembly)
    : m_free(Vector::Ones(6 * assembly.cells))
{
   for (std::int64_t i = 0; i < assembly.cells; ++i)
      for (int k = 0; k < 6; ++k)
         if (assembly.fixed[i] >> k & 1)
            m_free[6 * i + k] = 0;
   const auto rows = scene.channel("driven", 2);
   for (std::int64_t i = 0; i < rows.count(); ++i) {
      const Driven driven{rows.where(i), static_cast<int>(rows.row(i)[0]),
                          static_cast<std::int64_t>(rows.row(i)[1])};
      if (driven.freedom < 0 || driven.freedom > 5)
         throw Failure(DIATOM_BAD_INPUT, "the cell " + scene.name(driven.cell) +
                                             " is driven in a degree of freedom other than 0 to 5");
      m_free[6 * driven.cell + driven.freedom] = 0;
      m_driven.push_back(driven);
   }
   setCurves(scene.channels());
   for (const Driven &driven : m_driven)
      if (driven.curve < 0 || driven.curve >= static_cast<std::int64_t>(m_curves.size()) ||
          m_curves[driven.curve].time.empty())
         throw Failure(DIATOM_BAD_INPUT,
                       "the cell " + scene.name(driven.cell) + " is driven along a curve that has no points");
}

void Supports::setCurves(std::span<const diatom_channel> channels)
{
   const auto points = sdk::findChannel(channels, "curve", 2, -1);
   std::vector<Curve> curves;
   for (std::int64_t i = 0; i < points.count(); ++i) {
      const std::int64_t number = points.where(i);
      if (number < 0 || number > points.count())
         throw Failure(DIATOM_BAD_INPUT, "the curves are not numbered from 0 on");
      if (number >= static_cast<std::int64_t>(curves.size()))
         curves.resize(static_cast<std::size_t>(number) + 1);
      Curve &curve = curves[number];
      if (!curve.time.empty() && !(points.row(i)[0] > curve.time.back()))
         throw Failure(DIATOM_BAD_INPUT, "the times of curve " + std::to_string(number) + " do not ascend");
      curve.time.push_back(points.row(i)[0]);
      curve.value.push_back(points.row(i)[1]);
   }
   if (curves.size() < m_curves.size())
      throw Failure(DIATOM_UNSUPPORTED, "there are fewer curves than the supports follow");
   m_curves = std::move(curves);
}

double Supports::farthest(const Driven &driven) const
{
   double most = 0;
   for (const double value : m_curves[driven.curve].value)
      most = std::max(most, std::abs(value));
   return most;
}

Column Supports::targets(double time) const
{
   Column out;
   for (const Driven &driven : m_driven)
      out.push_back(valueOf(driven, time));
   return out;
}

void startPose(const sdk::SceneView &scene, State &state)
{
   const auto pose = scene.channel("pose", 6);
   for (std::int64_t i = 0; i < pose.count(); ++i) {
      const double *row = pose.row(i);
      for (int k = 0; k < 3; ++k)
         state.displacement(k)[pose.where(i)] = row[k];
      state.setTurnedOn(pose.where(i), {}, {row[3], row[4], row[5]});
   }
}

} // namespace bonds
