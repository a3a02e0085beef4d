#include "gui/readable.h"

#include <QCoreApplication>
#include <QRegularExpression>

#include <array>
#include <cmath>

namespace diatom::gui {

namespace {

struct Unit
{
   const char *name;
   double seconds;
};

constexpr std::array<Unit, 8> kUnits{{{"ns", 1e-9},
                                      {"us", 1e-6},
                                      {"ms", 1e-3},
                                      {"s", 1},
                                      {"min", 60},
                                      {"h", 3600},
                                      {"days", 86400},
                                      {"years", 31557600}}};

QString unknown() { return QCoreApplication::translate("Readable", "unknown"); }

} // namespace

QString figureText(double value)
{
   if (!std::isfinite(value))
      return unknown();
   if (value == 0)
      return QStringLiteral("0");
   const double size = std::abs(value);
   if (size >= 1e7 || size < 1e-4)
      return QString::number(value, 'g', 3);
   const int decimals = std::clamp(2 - static_cast<int>(std::floor(std::log10(size))), 0, 6);
   QString text = QString::number(value, 'f', decimals);
   if (text.contains(QLatin1Char('.')))
      text.remove(QRegularExpression(QStringLiteral("\\.?0+$")));
   return text;
}

QString durationText(double seconds)
{
   if (!std::isfinite(seconds) || seconds < 0)
      return unknown();
   const Unit *unit = &kUnits[seconds > 0 ? 0 : 3];
   for (const Unit &one : kUnits)
      // A unit is taken from two of it on, so that "90 s" is not "1.5 min"; those below a second from one.
      if (seconds >= one.seconds * (one.seconds > 1 ? 2 : 0.9995))
         unit = &one;
   return figureText(seconds / unit->seconds) + QLatin1Char(' ') + QLatin1String(unit->name);
}

QString lengthText(double metres)
{
   if (!std::isfinite(metres))
      return unknown();
   if (metres >= 1)
      return figureText(metres) + QStringLiteral(" m");
   if (metres >= 1e-4 || metres <= 0)
      return figureText(1e3 * metres) + QStringLiteral(" mm");
   if (metres >= 1e-7)
      return figureText(1e6 * metres) + QStringLiteral(" um");
   return figureText(1e9 * metres) + QStringLiteral(" nm");
}

QString percentText(double relative)
{
   if (!std::isfinite(relative) || relative < 0)
      return unknown();
   constexpr double kLeast = 1e-6;
   if (relative < kLeast)
      return QCoreApplication::translate("Readable", "under %1 %").arg(QStringLiteral("0.0001"));
   const double percent = 100 * relative;
   // Errors are estimates: two digits are as many as they have.
   return percent >= 10 ? QStringLiteral("%1 %").arg(percent, 0, 'f', 0)
                        : figureText(QString::number(percent, 'g', 2).toDouble()) + QStringLiteral(" %");
}

std::optional<double> parseDuration(const QString &text)
{
   static const QRegularExpression form(
       QStringLiteral("^\\s*([0-9.eE+-]*[0-9.])\\s*(\\x{b5}s|\\x{3bc}s|[a-z]*)\\s*$"));
   const auto match = form.match(text);
   bool number = false;
   const double value = match.captured(1).toDouble(&number);
   if (!match.hasMatch() || !number || !std::isfinite(value) || value <= 0)
      return std::nullopt;
   QString name = match.captured(2);
   if (name.isEmpty())
      name = QStringLiteral("s");
   if (name.size() == 2 && name[0].unicode() > 0x7f)
      name = QStringLiteral("us");
   for (const Unit &unit : kUnits)
      if (name == QLatin1String(unit.name))
         return value * unit.seconds;
   return std::nullopt;
}

std::optional<double> parsePercent(const QString &text)
{
   QString number = text.trimmed();
   if (number.endsWith(QLatin1Char('%')))
      number.chop(1);
   bool ok = false;
   const double value = number.trimmed().toDouble(&ok);
   return ok && value > 0 && value < 100 ? std::optional(value / 100) : std::nullopt;
}

QString wordText(const QString &word)
{
   QString text = word;
   text.replace(QLatin1Char('_'), QLatin1Char('-'));
   if (!text.isEmpty())
      text[0] = text[0].toUpper();
   return text;
}

} // namespace diatom::gui
