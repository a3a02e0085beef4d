#include "verify/actuated_scene.h"

namespace diatom {

namespace {

constexpr std::uint8_t kAlongX = 0x03;

} // namespace

ActuatedRow::ActuatedRow(CaseScene &scene, const nlohmann::json &constants, double mass)
    : m_scene(scene), m_conductor(scene.material(constants, mass)), m_rising(scene.material(constants, mass)),
      m_falling(scene.material(constants, mass))
{
   scene.change(m_conductor, [](Material &material) {
      material.role = ElectricalRole::conductor;
      material.ports = kAlongX;
   });
}

void ActuatedRow::drive(Actuation::Mode mode, double perBond)
{
   // One volt falls along a rising cell, from + on its right, and rises along a falling one.
   const auto give = [&](MaterialIndex index, double strain) {
      m_scene.change(index, [&](Material &material) {
         material.role = ElectricalRole::actuator;
         material.ports = kAlongX;
         material.actuation = {mode, mode == Actuation::Mode::bending ? 2 : 0, strain, false};
      });
   };
   give(m_rising, 2 * perBond);
   give(m_falling, -2 * perBond);
}

void ActuatedRow::fill(Index first, int cells)
{
   for (std::int32_t i = 0; i < cells; ++i) {
      const Index at = first + Index{i, 0, 0};
      // Sources at 2, 6, 10, ...: the actuator before one has + on its right.
      m_scene.cell(at, i % 2 == 0 ? m_conductor : i % 4 == 1 ? m_rising : m_falling);
      if (i % 4 != 2)
         continue;
      Source source;
      source.cell = at;
      source.waveform = Waveform::square;
      source.frequency = 0.1; // +1 V until 5 s
      source.amplitude = 2;
      m_scene.setup().sources.push_back(source);
   }
}

} // namespace diatom
