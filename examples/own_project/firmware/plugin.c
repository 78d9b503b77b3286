/* The board of the firmware, played by the bench: picoseconds there are nanoseconds here. */
#include <stdlib.h>
#include <string.h>

#include "firmware/island.h"
#include "harness/iut/fieldproof_plugin.h"

enum { VALVES = 0, LIMIT_SWITCHES = 1 }; /* items of the role valve_bus/node */

typedef struct {
  island firmware;
  island_board board;
  const fieldproof_bench* bench;
  fieldproof_time now;
  fieldproof_time bit;
  unsigned short ninth_bit;
} device;

static int64_t nanoseconds(fieldproof_time time) {
  return time / 1000;
}
static fieldproof_time picoseconds(int64_t time) {
  return time == ISLAND_NEVER ? FIELDPROOF_NEVER : time * 1000;
}

static void set_valves(void* self, uint16_t valves) {
  device* me = self;
  me->bench->write(me->bench->context, VALVES, valves, me->now);
}

static uint16_t limit_switches(void* self) {
  device* me = self;
  return (uint16_t)me->bench->read(me->bench->context, LIMIT_SWITCHES, me->now);
}

static void send(void* self, const uint8_t* octets, int64_t start_ns) {
  device* me = self;
  const fieldproof_time start = picoseconds(start_ns);
  const fieldproof_time length = 3 * picoseconds(me->firmware.character) + 1000;
  unsigned short characters[3];
  for (int n = 0; n < 3; ++n) characters[n] = (unsigned short)(me->ninth_bit | octets[n]);
  me->bench->driver(me->bench->context, 0, 1, start - me->bit);
  me->bench->characters(me->bench->context, 0, start, characters, 3);
  me->bench->driver(me->bench->context, 0, 0, start + length + me->bit);
}

static void* create(const char* protocol, const char* role, const fieldproof_bench* bench) {
  device* me = NULL;
  if (strcmp(protocol, "valve_bus") != 0 || strcmp(role, "node") != 0) return NULL;
  me = calloc(1, sizeof *me);
  if (me == NULL) return NULL;
  me->bench = bench;
  me->board = (island_board){me, set_valves, limit_switches, send};
  return me;
}

static fieldproof_time setting(const fieldproof_case* test_case, const char* name) {
  for (unsigned n = 0; n < test_case->setting_count; ++n)
    if (strcmp(test_case->settings[n].name, name) == 0) return test_case->settings[n].value;
  return 0;
}

static fieldproof_time next_time(const device* me) {
  return picoseconds(island_timer_at(&me->firmware));
}

static int begin(void* self, const fieldproof_case* test_case, fieldproof_time* next) {
  device* me = self;
  const fieldproof_time format = setting(test_case, "characters");
  const fieldproof_time told = setting(test_case, "bit_rate");
  const fieldproof_time tens = setting(test_case, "address_tens");
  const fieldproof_time units = setting(test_case, "address_units");
  const fieldproof_time bit_rate = told > 0 ? told : 62500; /* dip 2 */
  me->bit = INT64_C(1000000000000) / bit_rate;
  me->ninth_bit = format == 0 ? 0x100 : 0;
  memset(&me->firmware, 0, sizeof me->firmware);
  me->firmware.character = INT64_C(1000000000) * (format == 2 ? 10 : 11) / bit_rate;
  me->firmware.driver_ahead = nanoseconds(me->bit) + 1;
  me->firmware.address = (uint8_t)(tens > 9 || units > 9 ? 0 : 10 * tens + units);
  me->firmware.fitted = setting(test_case, "boards") == 1 ? 0x00FF : 0xFFFF;
  *next = next_time(me);
  return 1;
}

static fieldproof_time set_power(void* self, int is_on, fieldproof_time now) {
  device* me = self;
  me->now = now;
  island_power(&me->firmware, is_on);
  return next_time(me);
}

static fieldproof_time receive(void* self, unsigned port, const fieldproof_character* characters,
                               unsigned count, fieldproof_time now) {
  device* me = self;
  (void)port;
  me->now = now;
  for (unsigned n = 0; n < count; ++n) {
    const fieldproof_character* one = &characters[n];
    island_character(&me->firmware, &me->board, (uint8_t)one->data,
                     !one->is_parity_wrong && !one->is_stop_missing, nanoseconds(one->start),
                     nanoseconds(one->busy_until));
  }
  return next_time(me);
}

static fieldproof_time on_time(void* self, fieldproof_time now) {
  device* me = self;
  me->now = now;
  island_timer(&me->firmware, &me->board, nanoseconds(now));
  return next_time(me);
}

static void end(void* self) {
  (void)self;
}

const fieldproof_implementation* fieldproof_plugin(unsigned version) {
  static const fieldproof_implementation implementation = {
      .version = FIELDPROOF_PLUGIN_VERSION,
      .size = sizeof(fieldproof_implementation),
      .name = "valve island",
      .unit = FIELDPROOF_CHARACTERS,
      .create = create,
      .destroy = free,
      .begin = begin,
      .set_power = set_power,
      .receive = receive,
      .on_time = on_time,
      .end = end,
  };
  return version == FIELDPROOF_PLUGIN_VERSION ? &implementation : NULL;
}
