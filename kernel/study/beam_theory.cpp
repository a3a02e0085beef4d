#include "study/beam_theory.h"

#include <array>
#include <cmath>
#include <numbers>

namespace diatom {

namespace {

using State = std::array<double, 4>;

/// Stations along a bar: classical Runge-Kutta's error at this many is below 1e-10 of the answer.
constexpr int kStations = 2000;

template<typename Slope>
State integrated(State state, double length, int stations, const Slope &slope)
{
   const double h = length / stations;
   const auto moved = [](const State &from, const State &along, double by) {
      State to = from;
      for (std::size_t k = 0; k < to.size(); ++k)
         to[k] += by * along[k];
      return to;
   };
   for (int i = 0; i < stations; ++i) {
      const State a = slope(state), b = slope(moved(state, a, h / 2)), c = slope(moved(state, b, h / 2)),
                  d = slope(moved(state, c, h));
      for (std::size_t k = 0; k < state.size(); ++k)
         state[k] += h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
   }
   return state;
}

/// Where a function that changes sign between two places is zero.
template<typename Function>
double zeroBetween(double low, double high, const Function &f)
{
   const bool rising = f(high) > 0;
   for (int k = 0; k < 80; ++k) {
      const double middle = (low + high) / 2;
      ((f(middle) > 0) == rising ? high : low) = middle;
   }
   return (low + high) / 2;
}

/// Tip after bending with this moment at the clamp: angle, along, across, moment at the tip.
State bentBy(const Bar &bar, double force, double moment)
{
   return integrated({0, 0, 0, moment}, bar.length, kStations, [&](const State &s) {
      const double sine = std::sin(s[0]), cosine = std::cos(s[0]);
      const double stretch = 1 + force * sine / bar.axial, slide = force * cosine / bar.shear;
      const double along = stretch * cosine - slide * sine, across = stretch * sine + slide * cosine;
      return State{s[3] / bar.bending, along, across, -force * along};
   });
}

/// Deflection, turn, moment and shear force of a bar that swings at w (rad/s), from those at the clamp.
State swung(const Bar &bar, double w, State state, double length)
{
   const int stations = std::max(1, static_cast<int>(std::lround(kStations * length / bar.length)));
   return integrated(state, length, stations, [&](const State &s) {
      return State{s[1] + s[3] / bar.shear, s[2] / bar.bending, -s[3] - w * w * bar.turning * s[1],
                   -w * w * bar.mass * s[0]};
   });
}

/// Zero where the free end can be free: the determinant of moment and shear force there.
double freedomAt(const Bar &bar, double w)
{
   const State a = swung(bar, w, {0, 0, 1, 0}, bar.length), b = swung(bar, w, {0, 0, 0, 1}, bar.length);
   return a[2] * b[3] - a[3] * b[2];
}

} // namespace

Bar Bar::square(double length, double width, double youngsModulus, double poissonRatio, double density)
{
   const double area = width * width, second = area * area / 12;
   const double shearModulus = youngsModulus / (2 * (1 + poissonRatio));
   return {length,         youngsModulus * area, 5.0 / 6 * shearModulus * area, youngsModulus * second,
           density * area, density * second};
}

double sagOf(const Bar &bar, double load, double at)
{
   const double x = at, length = bar.length;
   return load / (24 * bar.bending) * x * x * (x * x - 4 * length * x + 6 * length * length) +
          load / bar.shear * (length * x - x * x / 2);
}

TipPosition bentTip(const Bar &bar, double force)
{
   // The lever arm is at most the length that the force stretches the bar to.
   const double most = force * bar.length * (1 + force / bar.axial + force / bar.shear);
   const double moment = zeroBetween(0, most, [&](double m) { return bentBy(bar, force, m)[3]; });
   const State tip = bentBy(bar, force, moment);
   return {tip[1], tip[2]};
}

double bendingFrequency(const Bar &bar)
{
   // Euler and Bernoulli's beam is stiffer and lighter to turn: its lowest frequency lies above.
   const double slope = 1.8751040687119611; // first root of cos x cosh x = -1
   const double above = slope * slope / (bar.length * bar.length) * std::sqrt(bar.bending / bar.mass);
   const double w = zeroBetween(1e-3 * above, 1.01 * above, [&](double one) { return freedomAt(bar, one); });
   return w / (2 * std::numbers::pi);
}

BarShape bendingShape(const Bar &bar, double frequency, double at)
{
   const double w = 2 * std::numbers::pi * frequency;
   const State a = swung(bar, w, {0, 0, 1, 0}, bar.length), b = swung(bar, w, {0, 0, 0, 1}, bar.length);
   // The mix of the two whose moment vanishes at the tip.
   const double share = -a[2] / b[2];
   const State start{0, 0, 1, share};
   const double tip = swung(bar, w, start, bar.length)[0];
   const State here = at > 0 ? swung(bar, w, start, at) : start;
   return {here[0] / tip, here[1] / tip};
}

} // namespace diatom
