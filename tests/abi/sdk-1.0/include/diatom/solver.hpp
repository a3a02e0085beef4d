// For authors of solvers: spans over a diatom_scene, and DIATOM_SOLVER(Class), which turns a class into the C
// table and the module. The class needs:
//    static const diatom_capabilities &capabilities();
//    static void estimate(Call, Values, const SceneView &, diatom_estimate &);
//    Class(Call, Values, const SceneView &);                       copies what it needs from the scene
//    void apply(Call, std::span<const diatom_channel>);            throws Failure(DIATOM_UNSUPPORTED, why)
//    for "make a new one" std::int32_t step(Call, const diatom_step_request &, diatom_step_result &); const
//    diatom_outputs &outputs() const; void read(Call, std::int64_t output, std::int64_t first, std::int64_t
//    count, double *values) const;
#pragma once

#include <diatom/abi/solver.h>
#include <diatom/plugin.hpp>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace diatom::sdk {
inline namespace v1 {

/// One named input of the scene; `row(i)` are the `stride` numbers of its i-th place.
class Channel
{
public:
   explicit Channel(const diatom_channel *channel) : m_channel(channel) {}

   explicit operator bool() const { return m_channel && m_channel->count > 0; }
   std::int64_t count() const { return m_channel ? m_channel->count : 0; }
   std::int64_t stride() const { return m_channel->stride; }
   std::int64_t where(std::int64_t i) const { return m_channel->where ? m_channel->where[i] : 0; }
   const double *row(std::int64_t i) const { return m_channel->values + i * m_channel->stride; }

private:
   const diatom_channel *m_channel;
};

/// Looks a channel up by name and checks that its rows are `stride` wide and, with `places` >= 0, lie in [0,
/// places).
inline Channel findChannel(std::span<const diatom_channel> channels, std::string_view name,
                           std::int64_t stride, std::int64_t places)
{
   for (const diatom_channel &channel : channels) {
      if (name != channel.name)
         continue;
      if (channel.stride != stride)
         throw Failure(DIATOM_BAD_INPUT, "the channel \"" + std::string(name) + "\" has " +
                                             std::to_string(channel.stride) + " numbers per row, expected " +
                                             std::to_string(stride));
      for (std::int64_t i = 0; places >= 0 && channel.where && i < channel.count; ++i)
         if (channel.where[i] < 0 || channel.where[i] >= places)
            throw Failure(DIATOM_BAD_INPUT, "row " + std::to_string(i) + " of the channel \"" +
                                                std::string(name) + "\" belongs to no cell of the scene");
      for (std::int64_t i = 0; i < channel.count * stride; ++i)
         if (!std::isfinite(channel.values[i]))
            throw Failure(DIATOM_NOT_FINITE,
                          "the channel \"" + std::string(name) + "\" holds a value that is no number");
      return Channel(&channel);
   }
   return Channel(nullptr);
}

/// The scene as spans; valid as long as the diatom_scene.
class SceneView
{
public:
   explicit SceneView(const diatom_scene *scene) : m_scene(scene) {}

   double pitch() const { return m_scene->pitch; }
   std::int64_t cells() const { return m_scene->cells; }
   std::int64_t links() const { return m_scene->links; }
   const std::int32_t *index(std::int64_t cell) const { return m_scene->cell_index + 3 * cell; }
   std::int32_t material(std::int64_t cell) const { return m_scene->cell_material[cell]; }
   const double *position(std::int64_t cell) const { return m_scene->cell_position + 3 * cell; }
   const double *orientation(std::int64_t cell) const { return m_scene->cell_orientation + 4 * cell; }
   const double *extent(std::int64_t cell) const { return m_scene->cell_extent + 3 * cell; }
   std::int32_t linkA(std::int64_t link) const { return m_scene->link_a[link]; }
   std::int32_t linkB(std::int64_t link) const { return m_scene->link_b[link]; }
   std::int32_t materials() const { return m_scene->materials; }
   std::span<const diatom_channel> channels() const
   {
      return {m_scene->channel, static_cast<std::size_t>(m_scene->channels)};
   }
   Channel channel(std::string_view name, std::int64_t stride) const
   {
      return findChannel(channels(), name, stride, m_scene->cells);
   }

   /// A material's property; not a number when the scene has none of that name or no value.
   double property(std::int32_t material, std::string_view name) const
   {
      for (std::int32_t p = 0; p < m_scene->properties; ++p)
         if (name == m_scene->property_name[p])
            return m_scene->property[static_cast<std::int64_t>(material) * m_scene->properties + p];
      return std::numeric_limits<double>::quiet_NaN();
   }

   bool hasEffect(std::string_view name) const
   {
      for (std::int64_t e = 0; e < m_scene->effects; ++e)
         if (name == m_scene->effect[e])
            return true;
      return false;
   }

   /// What is asked: "dynamics" unless the scene says otherwise.
   std::string_view analysis() const
   {
      return DIATOM_HAS(diatom_scene, m_scene, analysis) && m_scene->analysis ? m_scene->analysis
                                                                              : "dynamics";
   }

   /// "(x, y, z)" of a cell, for messages.
   std::string name(std::int64_t cell) const
   {
      const std::int32_t *i = index(cell);
      return "(" + std::to_string(i[0]) + ", " + std::to_string(i[1]) + ", " + std::to_string(i[2]) + ")";
   }

private:
   const diatom_scene *m_scene;
};

/// The C table of a solver class.
template<typename Solver>
struct SolverTable
{
   static std::int32_t capabilities(const diatom_call *call, const char *, const diatom_capabilities **caps)
   {
      return guarded(call, [&] { *caps = &Solver::capabilities(); });
   }
   static std::int32_t estimate(const diatom_call *call, const diatom_create *create,
                                const diatom_scene *scene, diatom_estimate *estimate)
   {
      return guarded(
          call, [&] { Solver::estimate(Call(call), Values(create->values), SceneView(scene), *estimate); });
   }
   static std::int32_t create(const diatom_call *call, const diatom_create *create, const diatom_scene *scene,
                              void **self)
   {
      return guarded(call, [&] {
         *self = std::make_unique<Solver>(Call(call), Values(create->values), SceneView(scene)).release();
      });
   }
   static std::int32_t apply(void *self, const diatom_call *call, const diatom_channel *channels,
                             std::int64_t count)
   {
      return guarded(call, [&] {
         static_cast<Solver *>(self)->apply(Call(call), {channels, static_cast<std::size_t>(count)});
      });
   }
   static std::int32_t step(void *self, const diatom_call *call, const diatom_step_request *request,
                            diatom_step_result *result)
   {
      std::int32_t status = DIATOM_OK;
      const std::int32_t thrown =
          guarded(call, [&] { status = static_cast<Solver *>(self)->step(Call(call), *request, *result); });
      return thrown != DIATOM_OK ? thrown : status;
   }
   static std::int32_t outputs(void *self, const diatom_call *call, const diatom_outputs **outputs)
   {
      return guarded(call, [&] { *outputs = &static_cast<const Solver *>(self)->outputs(); });
   }
   static std::int32_t read(void *self, const diatom_call *call, std::int64_t output, std::int64_t first,
                            std::int64_t count, double *values)
   {
      return guarded(call, [&] {
         const auto *solver = static_cast<const Solver *>(self);
         const diatom_outputs &all = solver->outputs();
         if (output < 0 || output >= all.count || first < 0 || count < 0 ||
             first + count > all.output[output].count)
            throw Failure(DIATOM_BAD_INPUT, "there is no such output, or it has fewer rows than asked for");
         solver->read(Call(call), output, first, count, values);
      });
   }
   static void destroy(void *self) { delete static_cast<Solver *>(self); }

   static constexpr diatom_solver kTable{capabilities, estimate, create, apply, step, outputs, read, destroy};
   static const void *get(const char *interface)
   {
      return std::strcmp(interface, DIATOM_SOLVER_1) == 0 ? &kTable : nullptr;
   }
};

} // namespace v1
} // namespace diatom::sdk

/// Defines the module of a solver plugin.
#define DIATOM_SOLVER(Class) DIATOM_MODULE(diatom::sdk::SolverTable<Class>::get)
