// Lengths, times and errors as people read and write them; SI inside. What is not a number is "unknown".
#pragma once

#include <QString>

#include <optional>

namespace diatom::gui {

/// "12.3 us", "4.5 ms", "1.2 s", "3 min", "5.5 h", "12 days".
QString durationText(double seconds);
/// "1.1 %"; "under 0.0001 %" for less than that.
QString percentText(double relative);
/// "2 mm", "35.6 um", "1.2 m".
QString lengthText(double metres);
/// Three digits that count: "4.1", "0.25", "12000".
QString figureText(double value);

/// "20 us", "0.5 ms", "2 min"; without a unit seconds. Nothing unless it is above 0.
std::optional<double> parseDuration(const QString &text);
/// "1 %" or "1": a hundredth. Nothing unless above 0 and below 100.
std::optional<double> parsePercent(const QString &text);

/// "(0,0,0), (1,0,0)".
template<typename Cells>
QString cellsText(const Cells &cells)
{
   QString text;
   for (const auto &cell : cells)
      text += (text.isEmpty() ? QString() : QStringLiteral(", ")) +
              QStringLiteral("(%1,%2,%3)").arg(cell.x).arg(cell.y).arg(cell.z);
   return text;
}

/// A plugin's or an effect's word for the screen: "semi_implicit" is "Semi-implicit".
QString wordText(const QString &word);

} // namespace diatom::gui
