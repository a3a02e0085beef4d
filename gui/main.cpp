// diatom-studio [FILE...] [--screenshot OUT.png] [--config DIR]
#include "gui/main_window.h"
#include "gui/plugin_consent.h"
#include "plugins/warnings.h"

#include <QApplication>
#include <QCommandLineParser>
#include <QStandardPaths>

#include <cstdio>
#include <memory>
#include <vector>

using namespace diatom;
using namespace diatom::gui;

namespace {

/// Takes the picture once files are open and painted, then ends the program.
void screenshotWhenReady(MainWindow &window, const QString &file)
{
   auto connection = std::make_shared<QMetaObject::Connection>();
   *connection =
       QObject::connect(&window.viewport(), &Viewport::framePainted, &window, [&window, file, connection] {
          if (window.busy() || window.viewport().frameId() < 2) {
             window.viewport().update();
             return;
          }
          QObject::disconnect(*connection);
          QMetaObject::invokeMethod(
              &window,
              [&window, file] {
                 const bool saved = window.grab().save(file);
                 if (!saved)
                    std::fprintf(stderr,
                                 "Cannot write %s; choose a folder that exists and may be written to.\n",
                                 qUtf8Printable(file));
                 QCoreApplication::exit(saved ? 0 : 4);
              },
              Qt::QueuedConnection);
       });
}

} // namespace

int main(int argc, char **argv)
{
   QSurfaceFormat format;
   format.setVersion(3, 3);
   format.setProfile(QSurfaceFormat::CoreProfile);
   QSurfaceFormat::setDefaultFormat(format);
   QApplication application(argc, argv);
   QCoreApplication::setApplicationName(QStringLiteral("diatom"));
   QCoreApplication::setApplicationVersion(QStringLiteral(DIATOM_VERSION));
   QGuiApplication::setApplicationDisplayName(QStringLiteral("Diatom"));
   QGuiApplication::setDesktopFileName(QStringLiteral("org.diatom_cad.Diatom"));

   QCommandLineParser parser;
   parser.setApplicationDescription(QStringLiteral("Design, simulate and assemble digital materials."));
   parser.addPositionalArgument(QStringLiteral("FILE"), QStringLiteral("Designs to open, one window each."),
                                QStringLiteral("[FILE...]"));
   const QCommandLineOption screenshot(QStringLiteral("screenshot"),
                                       QStringLiteral("Save a picture of the window and end."),
                                       QStringLiteral("PNG"));
   const QCommandLineOption config(QStringLiteral("config"), QStringLiteral("Folder for settings."),
                                   QStringLiteral("DIR"));
   parser.addOptions({screenshot, config});
   parser.addHelpOption();
   parser.addVersionOption();
   parser.process(application);

   const QString folder = parser.isSet(config)
                              ? parser.value(config)
                              : QStandardPaths::writableLocation(QStandardPaths::AppConfigLocation);
   QSettings settings(folder + QStringLiteral("/studio.ini"), QSettings::IniFormat);
   auto catalogue = findPlugins();
   if (!parser.isSet(screenshot)) // which nobody watches
      catalogue = askForConsent(catalogue, settings);
   std::vector<std::unique_ptr<MainWindow>> windows;
   setPluginWarnings([&windows](const std::string &sentence, PluginWarning) { // from any thread
      std::fprintf(stderr, "%s\n", sentence.c_str());
      QMetaObject::invokeMethod(
          qApp,
          [&windows, sentence] {
             for (const auto &window : windows)
                window->warn(QString::fromStdString(sentence));
          },
          Qt::QueuedConnection);
   });
   QStringList files = parser.positionalArguments();
   if (files.isEmpty())
      files.append(QString());
   for (const QString &file : files) {
      auto &window = windows.emplace_back(std::make_unique<MainWindow>(catalogue, &settings));
      window->show();
      if (!file.isEmpty())
         window->open(file.toStdString());
   }
   if (parser.isSet(screenshot))
      screenshotWhenReady(*windows.front(), parser.value(screenshot));
   const int code = QApplication::exec();
   setPluginWarnings({});
   return code;
}
