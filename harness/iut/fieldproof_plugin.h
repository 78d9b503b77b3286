/*
 * An implementation under test as a shared library. C89 and any compiler; nothing is allocated on one side
 * and freed on the other; no call keeps a pointer behind its return.
 *
 *   cc -O2 -flto -shared -fPIC -fvisibility=hidden -o libnode.so node.c
 *   fieldproof run PROTOCOL/ROLE/read/is_answered --iut plugin:./libnode.so
 *
 * The library exports one function, `fieldproof_plugin`; with -fvisibility=hidden it exports nothing else,
 * and calls between its own functions go straight. The bench calls what it returns in this order:
 *
 *   create  { begin  { set_power | receive | receive_levels | on_activity | on_time }...  end }...  destroy
 *
 * Calls come one at a time, in order of time. Within `set_power`, `receive`, `receive_levels`, `on_activity` and
 * `on_time` the implementation acts by calling the bench, at instants that are now or later, and each of them returns
 * the instant at which it wants `on_time`: one behind `now`, or FIELDPROOF_NEVER. The latest answer holds;
 * the ones before are forgotten. Several instances may live at once, each in a thread of its own: keep no
 * state outside of them. `fieldproof_plugin` itself is called once for each case, from several threads, too: let it
 * return what is constant.
 *
 * Times are picoseconds since the case began. Items and settings are those of the role; README.md beside this
 * file leads to them.
 */
#ifndef FIELDPROOF_PLUGIN_H
#define FIELDPROOF_PLUGIN_H

#ifdef __cplusplus
extern "C" {
#endif

#define FIELDPROOF_PLUGIN_VERSION 3

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
 * bits, FIELDPROOF_TELEGRAMS are those of a role that has some; they travel as characters. */
#define FIELDPROOF_CHARACTERS 1
#define FIELDPROOF_LEVELS 2
#define FIELDPROOF_TELEGRAMS 3

/* The bench keeps its characters in this shape and hands them over where they lie. */
#if defined(__GNUC__)
#define FIELDPROOF_AS_IT_LIES __attribute__((may_alias))
#else
#define FIELDPROOF_AS_IT_LIES
#endif

typedef struct FIELDPROOF_AS_IT_LIES fieldproof_character {
  fieldproof_time start;         /* of its start bit */
  fieldproof_time busy_until;    /* end of its last stop bit, or of the low line behind it */
  unsigned short data;           /* with a ninth bit, where the format has one */
  unsigned char is_parity_wrong; /* 0 or 1 */
  unsigned char is_stop_missing; /* 0 or 1 */
} fieldproof_character;

typedef struct fieldproof_setting {
  const char* name;
  fieldproof_time value;
} fieldproof_setting;

typedef struct fieldproof_case {
  const char* id; /* "PROTOCOL/ROLE/read/is_answered" */
  fieldproof_word seed;
  const fieldproof_setting* settings;
  unsigned setting_count;
} fieldproof_case;

/* What the implementation may call. `context` is the first argument of each. */
typedef struct fieldproof_bench {
  unsigned version; /* FIELDPROOF_PLUGIN_VERSION of the bench */
  unsigned size;    /* of this struct; later versions are longer */
  void* context;
  /* The driver of a line of characters goes on (1) or off (0) at this instant. It may be switched when its
   * time has come, or ahead; when it will go off nobody needs to know. A line of telegrams has no driver. */
  void (*driver)(void* context, unsigned port, int is_on, fieldproof_time at);
  /* `count` characters without a gap from `start` on, while the driver is on; or telegrams. */
  void (*characters)(void* context, unsigned port, fieldproof_time start, const unsigned short* characters,
                     unsigned count);
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
  int unit; /* FIELDPROOF_CHARACTERS, FIELDPROOF_LEVELS or FIELDPROOF_TELEGRAMS */

  /* An instance for a role, or null for a role that is not served. `bench` stays valid until `destroy`. */
  void* (*create)(const char* protocol, const char* role, const fieldproof_bench* bench);
  void (*destroy)(void* self);
  /* A case begins; nothing of the one before counts. 0: it is not served. `*next_time` is FIELDPROOF_NEVER;
   * who wants `on_time` before the supply comes writes the instant there. */
  int (*begin)(void* self, const fieldproof_case* test_case, fieldproof_time* next_time);
  /* The supply comes and goes; a case begins without it. Returns when on_time is wanted. */
  fieldproof_time (*set_power)(void* self, int is_on, fieldproof_time now);
  /* Characters that are over, or telegrams when they begin. Returns when on_time is wanted. May be null with
   * FIELDPROOF_LEVELS, unless the role tells some all the same. */
  fieldproof_time (*receive)(void* self, unsigned port, const fieldproof_character* characters,
                             unsigned count, fieldproof_time now);
  /* With FIELDPROOF_LEVELS: a transmission, and its end as `now`; the role says whether it is told then or
   * when it begins. Where it is told when it begins, its levels come from `start` on: act by that, `now` lies
   * ahead. Returns when on_time is wanted. May be null otherwise. */
  fieldproof_time (*receive_levels)(void* self, unsigned port, fieldproof_time start, fieldproof_time rate,
                                    const unsigned char* levels, unsigned count, fieldproof_time now);
  /* The instant has come that was asked for. Returns when on_time is wanted again. */
  fieldproof_time (*on_time)(void* self, fieldproof_time now);
  void (*end)(void* self);
  /* Others begin to drive the line at this port (1), or nobody of them does any more (0): before what they
   * drive is known, as a receiver senses a carrier or the first start bit. Null: it does not ask for that; so
   * does a table that ends before it. Returns when on_time is wanted. */
  fieldproof_time (*on_activity)(void* self, unsigned port, int begins, fieldproof_time now);
} fieldproof_implementation;

#if defined(__GNUC__)
#define FIELDPROOF_EXPORT __attribute__((visibility("default")))
#elif defined(_MSC_VER)
#define FIELDPROOF_EXPORT __declspec(dllexport)
#else
#define FIELDPROOF_EXPORT
#endif

/* What the library exports. `version` is that of the bench; null: there is none for it. */
FIELDPROOF_EXPORT const fieldproof_implementation* fieldproof_plugin(unsigned version);

#ifdef __cplusplus
}
#endif

#endif
