// Supports, drives, loads, starts and fields between Setup and JSON, and the cells that each is on.
#include "document/format.h"
#include "scene/fields.h"
#include "scene/holding.h"

#include <fmt/format.h>

namespace diatom {

namespace {

using nlohmann::ordered_json;

/// Turns are in radians, displacements in metres.
const char *curveKey(int freedom) { return freedom < 3 ? "curve_s_m" : "curve_s_rad"; }

Box readBox(const JsonPlace &place)
{
   if (!place.json().is_array() || place.json().size() != 2) {
      place.mustBe("two corners [[x, y, z], [x, y, z]]");
      return {};
   }
   const Box box{place.at(0).index(), place.at(1).index()};
   if (place.ok() && box.empty())
      place.mustBe(
          "the lowest corner and then the highest: no coordinate may fall from the first to the second");
   return box;
}

Curve readCurve(const JsonPlace &place)
{
   Curve curve;
   for (std::size_t i = 0; i < place.size() && place.ok(); ++i) {
      const auto point = place.at(i);
      if (point.array(2))
         curve.push_back({point.at(0).number(), point.at(1).number()});
   }
   if (place.ok())
      if (const std::string fault = curveFault(curve); !fault.empty())
         place.fail(fault + "; give points [time, value] from the earliest to the latest");
   return curve;
}

void put(ordered_json &json, const char *key, const std::array<double, 3> &values)
{
   if (values != std::array<double, 3>{})
      json[key] = values;
}

std::array<double, 3> numbersOr0(const JsonPlace &place, const char *key)
{
   return place.has(key) ? place.at(key).numbers3() : std::array<double, 3>{};
}

} // namespace

ordered_json whereJson(const Where &where)
{
   if (const auto *cell = std::get_if<Index>(&where))
      return {{"cell", indexJson(*cell)}};
   if (const auto *box = std::get_if<Box>(&where))
      return {{"box", ordered_json::array({indexJson(box->min), indexJson(box->max)})}};
   return {{"material", std::get<OfMaterial>(where).id}};
}

Where readWhere(const JsonPlace &place)
{
   if (!place.object())
      return {};
   const int given = int(place.has("cell")) + int(place.has("box")) + int(place.has("material"));
   if (given > 1)
      place.fail("is on more than one of cell, box and material; make an entry of each");
   if (place.has("box"))
      return readBox(place.at("box"));
   if (place.has("material"))
      return OfMaterial{place.at("material").identifier()};
   return place.at("cell").index();
}

ordered_json supportJson(const Support &support)
{
   ordered_json json = whereJson(support.where);
   if (support.fixed != kAllFreedoms)
      json["fixed"] = fixedJson(support.fixed);
   return json;
}

Support readSupport(const JsonPlace &place)
{
   place.known({"cell", "box", "material", "fixed"});
   return {readWhere(place), place.has("fixed") ? readFixed(place.at("fixed")) : kAllFreedoms};
}

ordered_json driveJson(const Drive &drive)
{
   ordered_json json = whereJson(drive.where);
   json["freedom"] = kFreedoms[static_cast<std::size_t>(drive.freedom)];
   auto points = ordered_json::array();
   for (const CurvePoint &point : drive.curve)
      points.push_back(ordered_json::array({point.time, point.value}));
   json[curveKey(drive.freedom)] = std::move(points);
   return json;
}

Drive readDrive(const JsonPlace &place)
{
   Drive drive;
   if (!place.object())
      return drive;
   place.known({"cell", "box", "material", "freedom", "curve_s_m", "curve_s_rad"});
   drive.where = readWhere(place);
   drive.freedom = static_cast<int>(place.at("freedom").word({"x", "y", "z", "rx", "ry", "rz"}));
   drive.curve = readCurve(place.at(curveKey(drive.freedom)));
   const char *other = curveKey(drive.freedom < 3 ? 3 : 0);
   if (place.has(other))
      place.at(other).fail(fmt::format("does not fit the freedom {}, whose curve is {}",
                                       kFreedoms[static_cast<std::size_t>(drive.freedom)],
                                       curveKey(drive.freedom)));
   return drive;
}

ordered_json loadJson(const Load &load)
{
   ordered_json json = whereJson(load.where);
   json["force_N"] = load.force;
   json["moment_N_m"] = load.moment;
   return json;
}

Load readLoad(const JsonPlace &place)
{
   Load load;
   if (!place.object())
      return load;
   place.known({"cell", "box", "material", "force_N", "moment_N_m"});
   return {readWhere(place), numbersOr0(place, "force_N"), numbersOr0(place, "moment_N_m")};
}

ordered_json startJson(const Start &start)
{
   ordered_json json = whereJson(start.where);
   put(json, "displacement_m", start.displacement);
   put(json, "turn_rad", start.turn);
   put(json, "velocity_m_s", start.velocity);
   put(json, "spin_rad_s", start.spin);
   if (start.about)
      json["about_m"] = *start.about;
   return json;
}

Start readStart(const JsonPlace &place)
{
   Start start;
   if (!place.object())
      return start;
   place.known(
       {"cell", "box", "material", "displacement_m", "turn_rad", "velocity_m_s", "spin_rad_s", "about_m"});
   start.where = readWhere(place);
   start.displacement = numbersOr0(place, "displacement_m");
   start.turn = numbersOr0(place, "turn_rad");
   start.velocity = numbersOr0(place, "velocity_m_s");
   start.spin = numbersOr0(place, "spin_rad_s");
   if (place.has("about_m"))
      start.about = place.at("about_m").numbers3();
   return start;
}

ordered_json fieldJson(const Field &field)
{
   ordered_json json = whereJson(field.where);
   json["name"] = field.name;
   json["values"] = field.values;
   return json;
}

Field readField(const JsonPlace &place)
{
   Field field;
   if (!place.object())
      return field;
   place.known({"cell", "box", "material", "name", "values"});
   field.where = readWhere(place);
   field.name = place.at("name").identifier();
   const auto values = place.at("values");
   for (std::size_t i = 0; i < values.size() && place.ok(); ++i)
      field.values.push_back(values.at(i).number());
   if (place.ok())
      if (const std::string fault = fieldFault(field); !fault.empty())
         place.fail(fault);
   return field;
}

} // namespace diatom
