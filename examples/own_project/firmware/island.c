#include "firmware/island.h"

enum { WRITE = 0, READ = 1, COMMAND_OCTETS = 5 };

static const int64_t processing = 120000;

void island_power(island* me, int is_on) {
  me->is_on = is_on;
  me->count = 0;
  me->is_spoilt = me->has_answer = 0;
  me->heard_until = me->sending_until = 0;
}

/* A character that began within the 3.5 characters of silence is over by then. */
static int64_t silence_known_at(const island* me) {
  return me->count > 0 ? me->heard_until + me->character * 5 : ISLAND_NEVER;
}

static void read_switches(island* me, const island_board* board) {
  const uint16_t switches = board->limit_switches(board->self) & me->fitted;
  me->answer[0] = (uint8_t)switches;
  me->answer[1] = (uint8_t)(switches >> 8);
  me->answer[2] = me->answer[0] ^ me->answer[1];
  me->answer_at = me->heard_until + me->character * 7 / 2 + processing;
  me->has_answer = 1;
}

static void end_frame(island* me, const island_board* board) {
  const uint8_t* f = me->frame;
  const int is_command =
      me->count == COMMAND_OCTETS && !me->is_spoilt && (f[0] ^ f[1] ^ f[2] ^ f[3] ^ f[4]) == 0;
  me->count = 0;
  me->is_spoilt = 0;
  if (!is_command || me->address == 0 || f[0] != me->address) return;
  if (f[1] == WRITE) board->set_valves(board->self, (uint16_t)(f[2] | f[3] << 8) & me->fitted);
  if (f[1] == READ) read_switches(me, board);
}

void island_character(island* me, const island_board* board, uint8_t octet, int is_good, int64_t start,
                      int64_t end) {
  const int64_t gap = start - me->heard_until;
  if (!me->is_on) return;
  if (me->count > 0 && gap >= me->character * 7 / 2) end_frame(me, board);
  me->has_answer = 0;                         /* the host has given it up */
  if (start < me->sending_until) is_good = 0; /* the receiver was off */
  if (!is_good || (me->count > 0 && gap > me->character * 3 / 2 + 1)) me->is_spoilt = 1;
  if (me->count < sizeof me->frame) me->frame[me->count++] = octet;
  me->heard_until = end;
}

void island_timer(island* me, const island_board* board, int64_t now) {
  if (now >= silence_known_at(me)) end_frame(me, board);
  if (me->has_answer && now >= me->answer_at - me->driver_ahead) {
    const int64_t start = me->answer_at > now + me->driver_ahead ? me->answer_at : now + me->driver_ahead;
    me->has_answer = 0;
    me->sending_until = start + 3 * me->character;
    board->send(board->self, me->answer, start);
  }
}

int64_t island_timer_at(const island* me) {
  const int64_t silence = silence_known_at(me);
  const int64_t answer = me->has_answer ? me->answer_at - me->driver_ahead : ISLAND_NEVER;
  if (!me->is_on) return ISLAND_NEVER;
  return silence < answer ? silence : answer;
}
