/* A machine in C alone: its program is one line for each part, with the place it is put at. */
#include <diatom/abi/machine.h>

#include <stdint.h>
#include <string.h>

#include DIATOM_PLUGIN_METADATA

static const char *const names[] = {"X", "Y", "Z"};
static const int32_t kinds[] = {DIATOM_AXIS_LINEAR, DIATOM_AXIS_LINEAR, DIATOM_AXIS_LINEAR};
static const double directions[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
static const double minima[] = {0, 0, 0}, maxima[] = {1, 1, 1}, homes[] = {0, 0, 0.5};
static const double speeds[] = {0.5, 0.5, 0.5}, accelerations[] = {1, 1, 1};
static const double feeder_positions[] = {0.9, 0.9, 0}, feeder_pitches[] = {0};
static const int32_t columns[] = {1}, rows[] = {1};

static const diatom_machine_description description = {.size = sizeof(diatom_machine_description),
                                                       .axes = 3,
                                                       .feeders = 1,
                                                       .axis_name = names,
                                                       .axis_kind = kinds,
                                                       .axis_direction = directions,
                                                       .axis_minimum = minima,
                                                       .axis_maximum = maxima,
                                                       .axis_home = homes,
                                                       .axis_speed = speeds,
                                                       .axis_acceleration = accelerations,
                                                       .feeder_position = feeder_positions,
                                                       .feeder_columns = columns,
                                                       .feeder_rows = rows,
                                                       .feeder_pitch = feeder_pitches,
                                                       .origin = {0.1, 0.1, 0},
                                                       .clearance = 0.05,
                                                       .approach = 0.01,
                                                       .feed = 0.1,
                                                       .grip_seconds = 0.5,
                                                       .suffix = "places"};

static int32_t create(const diatom_call *call, const diatom_create *create, void **self)
{
   static int anything;
   (void)call;
   (void)create;
   *self = &anything;
   return DIATOM_OK;
}

static int32_t describe(void *self, const diatom_call *call, const diatom_machine_description **machine)
{
   (void)self;
   (void)call;
   *machine = &description;
   return DIATOM_OK;
}

/* Decimal digits without the C library, whose output follows the locale. */
static char *put_number(char *at, int32_t number)
{
   char digits[12];
   int count = 0;
   uint32_t left = number < 0 ? 0u - (uint32_t)number : (uint32_t)number;
   if (number < 0)
      *at++ = '-';
   do {
      digits[count++] = (char)('0' + left % 10);
      left /= 10;
   } while (left > 0);
   while (count > 0)
      *at++ = digits[--count];
   return at;
}

static int32_t post(void *self, const diatom_call *call, const diatom_program *program,
                    const diatom_text_sink *sink)
{
   (void)self;
   for (int64_t i = 0; i < program->count; ++i) {
      char line[64], *at = line;
      if (call->cancelled(call))
         return DIATOM_CANCELLED;
      if (program->op[i] != DIATOM_OP_PLACE)
         continue;
      for (int k = 0; k < 3; ++k) {
         at = put_number(at, program->part_index[3 * program->part[i] + k]);
         *at++ = k < 2 ? ' ' : '\n';
      }
      const int32_t status = sink->text(sink, line, at - line);
      if (status != DIATOM_OK)
         return status;
   }
   return DIATOM_OK;
}

static void destroy(void *self) { (void)self; }

static const void *get(const char *interface_id)
{
   static const diatom_machine table = {create, describe, post, destroy};
   return strcmp(interface_id, DIATOM_MACHINE_1) == 0 ? &table : 0;
}

extern const diatom_module diatom_module_v1;
__attribute__((visibility("default"))) const diatom_module diatom_module_v1 = {
    sizeof(diatom_module), DIATOM_ABI_MINOR, 0, diatom_plugin_metadata, get};
