#include "plugins/scene_pack.h"

#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace diatom {

namespace {

constexpr std::size_t kAlignment = 64;

/// Writes one thing after another, each at its alignment; without room it only measures. The reader asks for
/// the same things in the same order.
class Packer
{
public:
   explicit Packer(std::byte *room) : m_room(room) {}

   template<typename T>
   void array(const T *from, std::int64_t count)
   {
      number(from ? count : -1);
      if (!from)
         return;
      m_at = (m_at + kAlignment - 1) / kAlignment * kAlignment;
      put(from, sizeof(T) * static_cast<std::size_t>(count));
   }
   void number(std::int64_t value)
   {
      m_at = (m_at + sizeof value - 1) / sizeof value * sizeof value;
      put(&value, sizeof value);
   }
   void real(double value)
   {
      m_at = (m_at + sizeof value - 1) / sizeof value * sizeof value;
      put(&value, sizeof value);
   }
   void text(const char *from) { array(from, from ? static_cast<std::int64_t>(std::strlen(from)) + 1 : 0); }
   void texts(const char *const *from, std::int64_t count)
   {
      number(from ? count : 0);
      for (std::int64_t k = 0; from && k < count; ++k)
         text(from[k]);
   }
   std::size_t size() const { return m_at; }

private:
   void put(const void *from, std::size_t bytes)
   {
      if (m_room && bytes > 0)
         std::memcpy(m_room + m_at, from, bytes);
      m_at += bytes;
   }
   std::byte *m_room;
   std::size_t m_at = 0;
};

void packChannels(Packer &packer, const diatom_channel *channels, std::int64_t count)
{
   packer.number(channels ? count : 0);
   for (std::int64_t k = 0; channels && k < count; ++k) {
      const diatom_channel &channel = channels[k];
      packer.text(channel.name);
      packer.number(channel.count);
      packer.number(channel.stride);
      packer.array(channel.where, channel.count);
      packer.array(channel.values, channel.count * channel.stride);
   }
}

void pack(Packer &packer, const SolverInput &input)
{
   const diatom_values none{sizeof none, 0, nullptr, nullptr, nullptr};
   const diatom_values &values = input.values ? *input.values : none;
   packer.texts(values.name, values.count);
   packer.array(values.number, values.count);
   packer.texts(values.text, values.count);
   packer.number(input.scene ? 1 : 0);
   if (!input.scene) {
      packChannels(packer, input.channels, input.channelCount);
      return;
   }
   const diatom_scene &scene = *input.scene;
   packer.real(scene.pitch);
   packer.number(scene.cells);
   packer.array(scene.cell_index, 3 * scene.cells);
   packer.array(scene.cell_material, scene.cells);
   packer.array(scene.cell_position, 3 * scene.cells);
   packer.array(scene.cell_orientation, 4 * scene.cells);
   packer.array(scene.cell_extent, 3 * scene.cells);
   packer.number(scene.links);
   packer.array(scene.link_a, scene.links);
   packer.array(scene.link_b, scene.links);
   packer.array(scene.link_axis, scene.links);
   packer.number(scene.materials);
   packer.texts(scene.property_name, scene.properties);
   packer.array(scene.property, std::int64_t{scene.materials} * scene.properties);
   packChannels(packer, scene.channel, scene.channels);
   packer.texts(scene.effect, scene.effects);
   packer.text(scene.analysis);
}

class Unpacker
{
public:
   Unpacker(std::byte *block, std::size_t bytes) : m_block(block), m_bytes(bytes) {}

   bool ok() const { return m_ok; }

   template<typename T>
   const T *array(std::int64_t wanted)
   {
      const std::int64_t count = number();
      if (count < 0)
         return nullptr;
      m_at = (m_at + kAlignment - 1) / kAlignment * kAlignment;
      m_ok = m_ok && count == wanted;
      return static_cast<const T *>(take(sizeof(T), count));
   }
   std::int64_t number() { return scalar<std::int64_t>(); }
   double real() { return scalar<double>(); }
   const char *text()
   {
      const std::int64_t length = number();
      if (length < 0)
         return nullptr;
      m_at = (m_at + kAlignment - 1) / kAlignment * kAlignment;
      const auto *found = static_cast<const char *>(take(1, length));
      m_ok = m_ok && length > 0 && found && found[length - 1] == '\0';
      return m_ok ? found : "";
   }
   std::vector<const char *> texts()
   {
      const std::int64_t count = number();
      std::vector<const char *> list;
      for (std::int64_t k = 0; k < count && m_ok; ++k)
         list.push_back(text());
      return list;
   }

private:
   template<typename T>
   T scalar()
   {
      m_at = (m_at + sizeof(T) - 1) / sizeof(T) * sizeof(T);
      T value{};
      if (const void *from = take(sizeof(T), 1))
         std::memcpy(&value, from, sizeof(T));
      return value;
   }
   const void *take(std::size_t each, std::int64_t count)
   {
      if (count < 0 || m_at > m_bytes || static_cast<std::uint64_t>(count) > (m_bytes - m_at) / each)
         m_ok = false;
      if (!m_ok)
         return nullptr;
      const std::byte *found = m_block + m_at;
      m_at += each * static_cast<std::size_t>(count);
      return found;
   }

   std::byte *m_block;
   std::size_t m_bytes, m_at = 0;
   bool m_ok = true;
};

std::vector<diatom_channel> unpackChannels(Unpacker &unpacker)
{
   const std::int64_t count = unpacker.number();
   std::vector<diatom_channel> channels;
   for (std::int64_t k = 0; k < count && unpacker.ok(); ++k) {
      diatom_channel channel{};
      channel.name = unpacker.text();
      channel.count = unpacker.number();
      channel.stride = unpacker.number();
      channel.where = unpacker.array<std::int64_t>(channel.count);
      channel.values = unpacker.array<double>(channel.count * channel.stride);
      channels.push_back(channel);
   }
   return channels;
}

} // namespace

std::size_t packedSize(const SolverInput &input)
{
   Packer packer(nullptr);
   pack(packer, input);
   return packer.size();
}

void packInput(const SolverInput &input, std::byte *room)
{
   Packer packer(room);
   pack(packer, input);
}

Result<std::unique_ptr<UnpackedInput>> UnpackedInput::of(std::byte *block, std::size_t bytes)
{
   std::unique_ptr<UnpackedInput> found(new UnpackedInput);
   Unpacker from(block, bytes);
   found->m_valueNames = from.texts();
   const auto count = static_cast<std::int64_t>(found->m_valueNames.size());
   const double *numbers = from.array<double>(count);
   found->m_valueTexts = from.texts();
   found->m_values = {sizeof(diatom_values), count, found->m_valueNames.data(), numbers,
                      found->m_valueTexts.data()};
   if (from.number() == 0) {
      found->m_channels = unpackChannels(from);
   } else {
      diatom_scene &scene = found->m_scene;
      scene.size = sizeof scene;
      scene.pitch = from.real();
      scene.cells = from.number();
      scene.cell_index = from.array<std::int32_t>(3 * scene.cells);
      scene.cell_material = from.array<std::int32_t>(scene.cells);
      scene.cell_position = from.array<double>(3 * scene.cells);
      scene.cell_orientation = from.array<double>(4 * scene.cells);
      scene.cell_extent = from.array<double>(3 * scene.cells);
      scene.links = from.number();
      scene.link_a = from.array<std::int32_t>(scene.links);
      scene.link_b = from.array<std::int32_t>(scene.links);
      scene.link_axis = from.array<std::int32_t>(scene.links);
      scene.materials = static_cast<std::int32_t>(from.number());
      found->m_propertyNames = from.texts();
      scene.properties = static_cast<std::int32_t>(found->m_propertyNames.size());
      scene.property_name = found->m_propertyNames.data();
      scene.property = from.array<double>(std::int64_t{scene.materials} * scene.properties);
      found->m_channels = unpackChannels(from);
      scene.channels = static_cast<std::int64_t>(found->m_channels.size());
      scene.channel = found->m_channels.data();
      found->m_effects = from.texts();
      scene.effects = static_cast<std::int64_t>(found->m_effects.size());
      scene.effect = found->m_effects.data();
      scene.analysis = from.text();
   }
   if (!from.ok())
      return Error{ErrorCode::internal, "what came from the other process is damaged"};
   return found;
}

} // namespace diatom
