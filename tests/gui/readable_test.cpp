// Times and errors as they are read and written; examples worked by hand.
#include "gui/readable.h"
#include "support/support.h"

#include <cmath>
#include <limits>

using namespace diatom::gui;

class ReadableTest : public QObject
{
   Q_OBJECT

private slots:
   void durations()
   {
      const std::pair<double, const char *> expected[] = {
          {0, "0 s"},      {2.5e-9, "2.5 ns"},    {1.234e-5, "12.3 us"}, {0.00999, "9.99 ms"},
          {0.9999, "1 s"}, {90, "90 s"},          {150, "2.5 min"},      {3600, "60 min"},
          {9000, "2.5 h"}, {200000, "2.31 days"}, {1e9, "31.7 years"}};
      for (const auto &[seconds, text] : expected)
         QCOMPARE(durationText(seconds), QString(text));
      for (const double bad :
           {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1.0})
         QCOMPARE(durationText(bad), QString("unknown"));
   }

   void whatIsShownIsReadBack()
   {
      for (const double seconds : {2.5e-9, 1.23e-5, 4.56e-3, 0.789, 12.0, 150.0, 9000.0})
         QVERIFY(std::abs(*parseDuration(durationText(seconds)) / seconds - 1) < 1e-12);
      QCOMPARE(*parseDuration("3"), 3.0);
      QCOMPARE(*parseDuration(QString::fromUtf8("20\xc2\xb5s")), 20e-6);
      for (const char *bad : {"", "0", "-1", "us", "1 fortnight", "inf", "nan", "1e999", "1 2", "0x10"})
         QVERIFY2(!parseDuration(bad), bad);
   }

   void errors()
   {
      const std::pair<double, const char *> expected[] = {{0.5, "50 %"},
                                                          {0.0123, "1.2 %"},
                                                          {0.000456, "0.046 %"},
                                                          {2e-6, "0.0002 %"},
                                                          {1e-9, "under 0.0001 %"}};
      for (const auto &[relative, text] : expected)
         QCOMPARE(percentText(relative), QString(text));
      QCOMPARE(percentText(std::numeric_limits<double>::quiet_NaN()), QString("unknown"));
      QCOMPARE(*parsePercent("1 %"), 0.01);
      QCOMPARE(*parsePercent(" 0.5"), 0.005);
      for (const char *bad : {"", "0", "100", "-1 %", "one", "nan", "inf %"})
         QVERIFY2(!parsePercent(bad), bad);
   }
};

QTEST_MAIN(ReadableTest)
#include "readable_test.moc"
