/* The line between Diatom and a plugin: one exported symbol, tables of functions found by id, records that
 * grow at their end. Plain C, no hidden padding, nothing is ever freed by the other side.
 *
 * Tags at the end of a function: [any] any thread, also at once on the same instance; [one] any thread, one
 * call at a time per instance; [call] only while the call that handed it out is running. Lengths are metres,
 * all numbers SI. */
#ifndef DIATOM_ABI_CORE_H
#define DIATOM_ABI_CORE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define DIATOM_ABI_MAJOR 1
#define DIATOM_ABI_MINOR 0

/* True when `record` is large enough to hold `field`: how a reader asks for a field added in a later minor.
 */
#define DIATOM_HAS(type, record, field)                                                                      \
   ((record)->size >= (int64_t)(offsetof(type, field) + sizeof((record)->field)))

/* Status of every call but destroy. CANCELLED and UNSUPPORTED are not errors. On any value but OK outputs are
 * void and the host commits nothing; the plugin has said why through report(). */
#define DIATOM_OK 0
#define DIATOM_CANCELLED 1
#define DIATOM_UNSUPPORTED 2
#define DIATOM_BAD_INPUT 3
#define DIATOM_NO_MEMORY 4
#define DIATOM_EXCEPTION 5
#define DIATOM_NOT_FINITE 6
#define DIATOM_LIMIT 7
#define DIATOM_INTERNAL 8

/* Levels of report(). */
#define DIATOM_DEBUG 0
#define DIATOM_INFO 1
#define DIATOM_WARNING 2
#define DIATOM_ERROR 3
#define DIATOM_HOST_MISBEHAVES 4

/* Host services. Owned by the host, valid until the call that received it returns. */
typedef struct diatom_call
{
   int64_t size;
   void *host;
   /* Text for the log or, before an error status, for the user. Copied at once. [call] */
   void (*report)(const struct diatom_call *call, int32_t level, const char *text);
   /* Not zero once the user asked to stop. Poll at least every 50 ms of work. [call] */
   int32_t (*cancelled)(const struct diatom_call *call);
   /* Fraction 0 to 1 of the work done; never needed for correctness. [call] */
   void (*progress)(const struct diatom_call *call, double fraction, const char *what);
   /* Runs body over [0, count) in pieces of `grain`, possibly at once. The split depends on grain only, never
    * on the number of threads. Nested calls run in place. The body must not let an exception out. [call] */
   int32_t (*parallel_for)(const struct diatom_call *call, int64_t count, int64_t grain,
                           void (*body)(void *context, int64_t begin, int64_t end), void *context);
   /* 64-byte aligned memory that is gone when the call returns; null when there is none left. [call] */
   void *(*scratch)(const struct diatom_call *call, int64_t bytes);
   /* Optional services by id; null when the host has no such service. [call] */
   const void *(*service)(const struct diatom_call *call, const char *id);
} diatom_call;

/* Parameter values, complete and checked by the host against plugin.json. A numeric parameter has its number
 * in SI; a choice or text parameter has its text, and number 0. */
typedef struct diatom_values
{
   int64_t size;
   int64_t count;
   const char *const *name;
   const double *number;
   const char *const *text;
} diatom_values;

/* What create() of every interface gets. Valid until create() returns. */
typedef struct diatom_create
{
   int64_t size;
   const char *id;     /* which of the module's provided things */
   const char *folder; /* the plugin's folder, for files of its own */
   const diatom_values *values;
} diatom_create;

/* The one exported symbol. `get` returns the table of an interface id such as "diatom.lattice/1", or null.
 * [any] */
typedef struct diatom_module
{
   int64_t size;
   uint32_t abi_minor;   /* the minor this module was built with, for information */
   uint32_t needs_minor; /* the host refuses to load below this minor */
   const char *metadata; /* the bytes of plugin.json; a difference means a half-updated install */
   const void *(*get)(const char *interface_id);
} diatom_module;

#define DIATOM_MODULE_SYMBOL "diatom_module_v1"

#ifdef __cplusplus
}
#endif
#endif
