/*
 * The node as a process; harness/iut/README.md describes the messages. An argument names a mutant.
 *
 *   cc -I. -o valve_node examples/valve_node/process.c examples/valve_node/valve_node.c
 *   fieldproof run valve_bus/node/read/is_answered --iut 'exec:./valve_node'
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "examples/valve_node/valve_node.h"

enum { HELLO = 1, ECHO, CASE_BEGIN, POWER, RECEIVE, ON_TIME = 7, CASE_END, VALUE };
enum { CAPABILITIES = 129, ECHOED, DONE, UNSUPPORTED, CHARACTERS, WRITE = 135, READ, DRIVER };

static unsigned char *message, *at; /* the last one that came, and how far it has been read */
static unsigned char out[64], *end; /* the one that goes, and how far it has been written */
static unsigned length;
static fieldproof_time next; /* when the node wants to be called again */

static fieldproof_word number(unsigned octets) {
  fieldproof_word value = 0;
  unsigned n;
  for (n = 0; n < octets; ++n) value |= (fieldproof_word)*at++ << (8 * n);
  return value;
}

static unsigned next_message(void) { /* its type */
  unsigned char head[4];
  if (fread(head, 1, 4, stdin) != 4) exit(0); /* the bench has gone */
  length = head[0] | (unsigned)head[1] << 8 | (unsigned)head[2] << 16 | (unsigned)head[3] << 24;
  message = (unsigned char*)realloc(message, length + 1);
  if (message == 0 || fread(message, 1, length, stdin) != length) exit(1);
  at = message + 1;
  return message[0];
}

static char* text(void) {
  const unsigned octets = (unsigned)number(2);
  char* copy = (char*)calloc(octets + 1, 1);
  memcpy(copy, at, octets);
  at += octets;
  return copy;
}

static void put(fieldproof_word value, unsigned octets) {
  for (; octets > 0; --octets, value >>= 8) *end++ = (unsigned char)(value & 0xFF);
}

static void put_text(const char* octets) {
  const size_t count = strlen(octets);
  put((fieldproof_word)count, 2);
  memcpy(end, octets, count), end += count;
}

static void begin_message(unsigned type) {
  end = out + 4, put(type, 1);
}

static void send_message(void) {
  const unsigned octets = (unsigned)(end - out);
  end = out;
  put(octets - 4, 4);
  fwrite(out, 1, octets, stdout);
  fflush(stdout);
}

static void switch_driver(void* context, unsigned port, int is_on, fieldproof_time at_instant) {
  (void)context;
  begin_message(DRIVER);
  put(port, 1), put(is_on != 0, 1), put((fieldproof_word)at_instant, 8);
  send_message();
}

static void send_characters(void* context, unsigned port, fieldproof_time start,
                            const unsigned short* characters, unsigned count) {
  (void)context;
  begin_message(CHARACTERS);
  put(port, 1), put((fieldproof_word)start, 8), put(count, 2);
  for (; count > 0; --count) put(*characters++, 2);
  send_message();
}

static void write_item(void* context, unsigned item, fieldproof_word value, fieldproof_time when) {
  (void)context;
  begin_message(WRITE);
  put(item, 2), put(value, 8), put((fieldproof_word)when, 8);
  send_message();
}

static fieldproof_word read_item(void* context, unsigned item, fieldproof_time when) {
  (void)context;
  begin_message(READ);
  put(item, 2), put((fieldproof_word)when, 8);
  send_message();
  return next_message() == VALUE ? number(8) : 0;
}

static int begin_case(valve_node* node) {
  fieldproof_setting settings[32];
  fieldproof_case test_case;
  char* id = text();
  const int is_served = strncmp(id, "valve_bus/node/", 15) == 0;
  test_case.seed = number(8);
  test_case.setting_count = (unsigned)number(2);
  if (test_case.setting_count <= 32 && is_served) {
    unsigned n;
    for (n = 0; n < test_case.setting_count; ++n) {
      settings[n].name = text();
      settings[n].value = (fieldproof_time)number(8);
    }
    test_case.id = id, test_case.settings = settings;
    next = valve_node_begin(node, &test_case);
    for (n = 0; n < test_case.setting_count; ++n) free((void*)settings[n].name);
  }
  free(id);
  return is_served;
}

static void receive(valve_node* node) {
  const fieldproof_time now = (++at, (fieldproof_time)number(8)); /* behind the port: a node has one */
  unsigned count = (unsigned)number(2);
  for (; count > 0; --count) {
    fieldproof_character character;
    character.start = (fieldproof_time)number(8);
    character.busy_until = (fieldproof_time)number(8);
    character.data = (unsigned short)number(2);
    character.is_parity_wrong = *at & 1, character.is_stop_missing = *at++ >> 1 & 1;
    next = valve_node_receive(node, &character, 1, now);
  }
}

static void answer(valve_node* node, unsigned type) {
  int is_served = 1, is_on = type == POWER && number(1) != 0;
  if (type == HELLO) {
    begin_message(CAPABILITIES);
    put(3, 2), put(FIELDPROOF_CHARACTERS, 1), put_text("node");
    put(1, 2), put_text("valve_bus"), put_text("node"); /* the one role that it serves */
  } else if (type == ECHO) {
    begin_message(ECHOED);
    memcpy(end, at, length - 1 < 32 ? length - 1 : 32), end += length - 1 < 32 ? length - 1 : 32;
  } else {
    if (type == CASE_BEGIN) is_served = begin_case(node);
    if (type == POWER) next = valve_node_power(node, is_on, (fieldproof_time)number(8));
    if (type == RECEIVE) receive(node);
    if (type == ON_TIME) next = valve_node_on_time(node, (fieldproof_time)number(8));
    begin_message(is_served ? DONE : UNSUPPORTED);
    if (is_served) put((fieldproof_word)next, 8);
  }
  send_message();
}

int main(int argc, char** argv) {
  static fieldproof_bench bench;
  static valve_node node;
  int n;
  bench.driver = switch_driver, bench.characters = send_characters, bench.write = write_item, bench.read = read_item;
  node.bench = &bench;
  for (n = 0; argc > 1 && n < MUTANTS; ++n)
    if (strcmp(valve_mutant_name((valve_mutant)n), argv[1]) == 0) node.mutant = (valve_mutant)n;
  for (;;) answer(&node, next_message());
}
