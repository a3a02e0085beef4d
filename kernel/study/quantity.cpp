#include "study/quantity.h"

#include "core/text.h"
#include "scene/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace diatom {

namespace {

Error badForm(std::string_view text)
{
   return {ErrorCode::usage,
           fmt::format("the quantity \"{}\" is not of the form X,Y,Z:CHANNEL, with @SECONDS, @rest or "
                       "@frequency after it if wanted, as in 0,13,0:z@0.05",
                       text)};
}

std::optional<Index> readIndex(std::string_view text)
{
   std::array<std::int32_t, 3> values{};
   for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t end = k < 2 ? text.find(',') : text.size();
      const auto value = end == std::string_view::npos ? std::nullopt : parseInteger(text.substr(0, end));
      if (!value || *value < -kIndexLimit || *value > kIndexLimit)
         return std::nullopt;
      values[k] = static_cast<std::int32_t>(*value);
      text.remove_prefix(k < 2 ? end + 1 : end);
   }
   return Index{values[0], values[1], values[2]};
}

/// Of a channel; nothing when there is no such channel.
std::optional<std::string> channelUnit(std::string_view name)
{
   for (const auto &[channel, unit] : Simulation::probeChannels())
      if (channel == name)
         return unit;
   return std::nullopt;
}

} // namespace

std::string Quantity::text() const
{
   std::string suffix;
   if (when == When::atTime)
      suffix = "@" + numberText(time);
   else if (when != When::throughout)
      suffix = when == When::atRest ? "@rest" : "@frequency";
   return fmt::format("{},{},{}:{}{}", cell.x, cell.y, cell.z, channel, suffix);
}

std::string Quantity::unit() const
{
   return when == When::frequency ? "Hz" : channelUnit(channel).value_or("");
}

Result<Quantity> parseQuantity(std::string_view text)
{
   const std::size_t colon = text.find(':');
   if (colon == std::string_view::npos)
      return badForm(text);
   const auto cell = readIndex(text.substr(0, colon));
   if (!cell)
      return badForm(text);
   const std::size_t at = text.find('@', colon);
   Quantity quantity;
   quantity.cell = *cell;
   quantity.channel = text.substr(colon + 1, at == std::string_view::npos ? at : at - colon - 1);
   if (!channelUnit(quantity.channel)) {
      std::string known;
      for (const auto &[channel, unit] : Simulation::probeChannels())
         known += " " + channel;
      return Error{ErrorCode::usage,
                   fmt::format("the quantity \"{}\" names no channel there is:{}", text, known)};
   }
   if (at == std::string_view::npos)
      return quantity;
   const std::string_view when = text.substr(at + 1);
   if (when == "rest" || when == "frequency") {
      quantity.when = when == "rest" ? Quantity::When::atRest : Quantity::When::frequency;
      return quantity;
   }
   const auto time = parseNumber(when);
   if (!time || *time <= 0)
      return badForm(text);
   quantity.when = Quantity::When::atTime;
   quantity.time = *time;
   return quantity;
}

std::optional<double> historyFrequency(const History &curve)
{
   if (curve.value.size() < 3)
      return std::nullopt;
   const auto [low, high] = std::minmax_element(curve.value.begin(), curve.value.end());
   const double middle = (*low + *high) / 2;
   std::vector<double> crossings;
   for (std::size_t k = 1; k < curve.value.size(); ++k) {
      const double before = curve.value[k - 1] - middle, after = curve.value[k] - middle;
      if (before < 0 && after >= 0)
         crossings.push_back(curve.time[k - 1] +
                             (curve.time[k] - curve.time[k - 1]) * before / (before - after));
   }
   if (crossings.size() < 2)
      return std::nullopt;
   return static_cast<double>(crossings.size() - 1) / (crossings.back() - crossings.front());
}

} // namespace diatom
