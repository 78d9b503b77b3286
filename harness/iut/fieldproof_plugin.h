/*
 * An implementation under test as a shared library. C89 and any compiler; nothing is allocated on one side
 * and freed on the other; no call keeps a pointer behind its return.
 *
 *   cc -shared -fPIC -o libnode.so node.c
 *   fieldproof run valve_bus/node/read/is_answered --iut plugin:./libnode.so
 *
 * The library exports one function, `fieldproof_plugin`. The bench calls what it returns in this order:
 *
 *   create  { begin  { set_power | receive | receive_levels | on_time }...  end }...  destroy
 *
 * and asks `next_time` behind each of them. Calls come one at a time, in order of time. Within
 * `set_power`, `receive`, `receive_levels` and `on_time` the implementation acts by calling the bench, at
 * instants that are now or later. Several instances may live at once, each in a thread of its own: keep no
 * state outside of them.
 *
 * Times are picoseconds since the case began. Items and settings are those of the role; README.md beside this
 * file leads to them.
 */
#ifndef FIELDPROOF_PLUGIN_H
#define FIELDPROOF_PLUGIN_H

#ifdef __cplusplus
extern "C" {
#endif

#define FIELDPROOF_PLUGIN_VERSION 1

#if defined(__GNUC__)
__extension__ typedef long long fieldproof_time;
__extension__ typedef unsigned long long fieldproof_word;
#elif defined(_MSC_VER)
typedef __int64 fieldproof_time;
typedef unsigned __int64 fieldproof_word;
#else
typedef long long fieldproof_time;
typedef unsigned long long fieldproof_word;
#endif

/* The instant that never comes. */
#define FIELDPROOF_NEVER ((fieldproof_time)(~(fieldproof_word)0 >> 1))

/* How a line is told: FIELDPROOF_CHARACTERS are those of an asynchronous line, FIELDPROOF_LEVELS are packed
 * bits. */
#define FIELDPROOF_CHARACTERS 1
#define FIELDPROOF_LEVELS 2

#define FIELDPROOF_PARITY_WRONG 1
#define FIELDPROOF_STOP_MISSING 2

typedef struct fieldproof_character {
  fieldproof_time start;      /* of its start bit */
  fieldproof_time busy_until; /* end of its last stop bit, or of the low line behind it */
  unsigned short data;        /* with a ninth bit, where the format has one */
  unsigned short flags;       /* FIELDPROOF_PARITY_WRONG, FIELDPROOF_STOP_MISSING */
} fieldproof_character;

typedef struct fieldproof_setting {
  const char* name;
  fieldproof_time value;
} fieldproof_setting;

typedef struct fieldproof_case {
  const char* id; /* "valve_bus/node/read/is_answered" */
  fieldproof_word seed;
  const fieldproof_setting* settings;
  unsigned setting_count;
} fieldproof_case;

/* What the implementation may call. `context` is the first argument of each. */
typedef struct fieldproof_bench {
  unsigned version; /* FIELDPROOF_PLUGIN_VERSION of the bench */
  unsigned size;    /* of this struct; later versions are longer */
  void* context;
  /* `count` characters without a gap from `start` on, with the driver on around them. */
  void (*transmit)(void* context, unsigned port, fieldproof_time driver_on, fieldproof_time start,
                   fieldproof_time driver_off, const unsigned short* characters, unsigned count);
  /* `count` levels, the first in bit 0 of levels[0], each 1/rate seconds long. */
  void (*transmit_levels)(void* context, unsigned port, fieldproof_time start, fieldproof_time rate,
                          const unsigned char* levels, unsigned count);
  /* An output of the process side has this value from `when` on. */
  void (*write)(void* context, unsigned item, fieldproof_word value, fieldproof_time when);
  /* What an input of the process side is at `when`. */
  fieldproof_word (*read)(void* context, unsigned item, fieldproof_time when);
  /* A line for people; it stands beside a finding. */
  void (*log)(void* context, const char* text);
} fieldproof_bench;

typedef struct fieldproof_implementation {
  unsigned version; /* FIELDPROOF_PLUGIN_VERSION */
  unsigned size;    /* sizeof(fieldproof_implementation) */
  const char* name;
  int unit; /* FIELDPROOF_CHARACTERS or FIELDPROOF_LEVELS */

  /* An instance for a role, or null for a role that is not served. `bench` stays valid until `destroy`. */
  void* (*create)(const char* protocol, const char* role, const fieldproof_bench* bench);
  void (*destroy)(void* self);
  /* A case begins; nothing of the one before counts. 0: it is not served. */
  int (*begin)(void* self, const fieldproof_case* test_case);
  /* The supply comes and goes; a case begins without it. */
  void (*set_power)(void* self, int is_on, fieldproof_time now);
  /* Characters that are over. May be null with FIELDPROOF_LEVELS, unless the role tells some all the
   * same. */
  void (*receive)(void* self, unsigned port, const fieldproof_character* characters, unsigned count,
                  fieldproof_time now);
  /* With FIELDPROOF_LEVELS: a transmission, and its end as `now`; the role says whether it is told then or
   * when it begins. May be null otherwise. */
  void (*receive_levels)(void* self, unsigned port, fieldproof_time start, fieldproof_time rate,
                         const unsigned char* levels, unsigned count, fieldproof_time now);
  void (*on_time)(void* self, fieldproof_time now);
  /* When on_time is wanted, FIELDPROOF_NEVER for never. */
  fieldproof_time (*next_time)(void* self);
  void (*end)(void* self);
} fieldproof_implementation;

/* What the library exports. `version` is that of the bench; null: there is none for it. */
const fieldproof_implementation* fieldproof_plugin(unsigned version);

#ifdef __cplusplus
}
#endif

#endif
