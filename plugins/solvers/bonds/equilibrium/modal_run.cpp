#include "equilibrium/modal_run.h"

#include "equilibrium/rigid_motion.h"
#include "model/stable_step.h"
#include "solid/couplings.h"

namespace bonds {

using sdk::Failure;

namespace {

/// As many as there are free degrees of freedom at most.
std::int64_t wantedOf(const sdk::Values &values, const Balance &balance)
{
   return std::min(static_cast<std::int64_t>(values.number("modes")),
                   static_cast<std::int64_t>(balance.supports().free().sum()));
}

} // namespace

void ModalRun::estimate(const Options &options, const sdk::SceneView &scene, diatom_estimate &estimate)
{
   StaticRun::estimate(options, scene, estimate);
   estimate.bytes += static_cast<double>(scene.cells()) * 6 * 8 * 100; // vectors of the subspace
   Assembly undamped(scene, options);
   for (BondConstants &k : undamped.constants)
      for (int j = 0; j < 3; ++j)
         k.d[j] = k.e[j] = 0;
   const StableStep stable =
       stableStep(undamped, options, makeCouplings(scene, undamped)); // 4 / step^2 bounds the eigenvalues
   estimate.stable_step = stable.step;
   estimate.stable_link = stable.bond < 0 ? -1 : undamped.link[stable.bond];
}

ModalRun::ModalRun(const Options &options, const sdk::Values &values, const sdk::SceneView &scene)
    : m_static(options, values, scene), m_wanted(wantedOf(values, m_static.balance())),
      m_highest(values.text("modes_from") == "highest"),
      m_readout(m_static.balance(),
                {{"eigenvalue", "rad2/s2", m_wanted, 1}, {"mode", "", m_wanted * scene.cells(), 6}})
{}

void ModalRun::apply(const sdk::Call &call, std::span<const diatom_channel> channels)
{
   m_static.apply(call, channels);
}

/// What floats free has no balance to seek: it must be in balance as it is.
std::int32_t ModalRun::findBalance(const sdk::Call &call, const diatom_step_request &request,
                                   diatom_step_result &result)
{
   const LooseMotion loose = findLoose(m_static.balance(), m_static.state());
   if (loose.cell < 0)
      return m_static.step(call, request, result);
   if (!m_static.inBalance(call, request, result))
      throw Failure(DIATOM_BAD_INPUT, "the part that the cell " + m_static.balance().name(loose.cell) +
                                          " belongs to is free to " + freedomText(loose.freedom) +
                                          " while loads, gravity or signals act: hold it, or take them away");
   return DIATOM_OK;
}

std::int32_t ModalRun::step(const sdk::Call &call, const diatom_step_request &request,
                            diatom_step_result &result)
{
   const std::int32_t status = findBalance(call, request, result);
   if (status != DIATOM_OK || result.state != DIATOM_CONVERGED)
      return status;
   m_modes = (m_highest ? highestModes : lowestModes)(call, m_static.balance(), m_static.state(),
                                                      m_static.statics().loading(), m_wanted);
   if (m_modes.cancelled)
      return DIATOM_CANCELLED;
   if (!m_modes.complete)
      throw Failure(DIATOM_LIMIT, "only " + std::to_string(m_modes.eigenvalue.size()) +
                                      " modes were found, or not sharply enough; ask for fewer");
   return DIATOM_OK;
}

void ModalRun::read(std::int64_t output, std::int64_t first, std::int64_t count, double *values) const
{
   if (output < Readout::kShared)
      return m_static.read(output, first, count, values);
   if (static_cast<std::int64_t>(m_modes.eigenvalue.size()) < m_wanted)
      throw Failure(DIATOM_BAD_INPUT, "the modes have not been sought yet");
   if (output == Readout::kShared) {
      std::copy_n(m_modes.eigenvalue.begin() + first, count, values);
      return;
   }
   const std::int64_t cells = m_static.state().n;
   for (std::int64_t i = first; i < first + count; ++i)
      std::copy_n(m_modes.shape[i / cells].data() + 6 * (i % cells), 6, values + 6 * (i - first));
}

} // namespace bonds
