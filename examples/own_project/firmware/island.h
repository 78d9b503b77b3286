/* The firmware of the valve island: a local node of the valve bus. It is called by the interrupts of the
 * board and calls the board. Times are nanoseconds of the board's clock. */
#ifndef ISLAND_H
#define ISLAND_H

#include <stdint.h>

#define ISLAND_NEVER INT64_MAX

typedef struct {
  void* self;
  void (*set_valves)(void* self, uint16_t valves);
  uint16_t (*limit_switches)(void* self);
  /* Three octets without a gap from `start` on. */
  void (*send)(void* self, const uint8_t* octets, int64_t start);
} island_board;

typedef struct {
  /* As the DIP switches say. */
  int64_t character;    /* duration of one */
  int64_t driver_ahead; /* of the first start bit: the driver is switched on so long before it */
  uint8_t address;
  uint16_t fitted; /* which valves there are */

  int is_on, is_spoilt, has_answer;
  unsigned count;
  uint8_t frame[6];
  uint8_t answer[3];
  int64_t heard_until, answer_at, sending_until;
} island;

void island_power(island* me, int is_on);
void island_character(island* me, const island_board* board, uint8_t octet, int is_good, int64_t start,
                      int64_t end);
void island_timer(island* me, const island_board* board, int64_t now);
/* When island_timer is wanted. */
int64_t island_timer_at(const island* me);

#endif
