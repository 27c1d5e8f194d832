/* SPDX-License-Identifier: Apache-2.0 */
#ifndef KERF_HAPKIT_FRAME_H
#define KERF_HAPKIT_FRAME_H

/*
 * What this sketch and its host say to each other, how the half turns of the sensor are counted, and when the
 * motor is let go (README.md). C without the board, so that the tests of Kerf run it too.
 */

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define HAPKIT_BAUD 500000
#define HAPKIT_VERSION 1
#define HAPKIT_FRAME_SIZE 13
#define HAPKIT_ORDER_SIZE 6
#define HAPKIT_MOST_DUTY 255
#define HAPKIT_WATCHDOG_MS 20

/* Of the status of a frame. */
#define HAPKIT_LET_GO 1u     /* no order for so long that the motor is off; also before the first */
#define HAPKIT_FRESH 2u      /* no order at all since it began */
#define HAPKIT_UNSURE 4u     /* the sensor was read between its ends: this place is none */
#define HAPKIT_REFUSED 8u    /* bytes that are no order have come since the frame before */
#define HAPKIT_SATURATED 16u /* the last order asked for more than there is */

typedef struct hapkit_frame {
  uint16_t count;  /* milliseconds since it began, modulo 65536 */
  uint16_t sensor; /* 0 to 1023 */
  int8_t flips;    /* half turns of the sensor since it began */
  uint8_t status;
  uint8_t order; /* number of the last order that was taken */
  int16_t duty;  /* of the motor, of 255 */
} hapkit_frame;

typedef struct hapkit_order {
  uint8_t number;
  int16_t duty;
} hapkit_order;

/* CRC-16 with the polynomial 1021h, from FFFFh on, highest bit first. */
static inline uint16_t hapkit_crc(const uint8_t* bytes, uint8_t size) {
  uint16_t crc = 0xFFFFu;
  for (uint8_t i = 0; i < size; ++i) {
    crc = (uint16_t)(crc ^ ((uint16_t)bytes[i] << 8));
    for (uint8_t bit = 0; bit < 8; ++bit)
      crc = (uint16_t)((crc & 0x8000u) != 0 ? (uint16_t)(crc << 1) ^ 0x1021u : (uint16_t)(crc << 1));
  }
  return crc;
}

static inline void hapkit_put16(uint8_t* bytes, uint16_t word) {
  bytes[0] = (uint8_t)(word & 0xFFu);
  bytes[1] = (uint8_t)(word >> 8);
}

static inline void hapkit_put_frame(const hapkit_frame* frame, uint8_t* bytes) {
  bytes[0] = 0xA5;
  bytes[1] = HAPKIT_VERSION;
  hapkit_put16(bytes + 2, frame->count);
  hapkit_put16(bytes + 4, frame->sensor);
  bytes[6] = (uint8_t)frame->flips;
  bytes[7] = frame->status;
  bytes[8] = frame->order;
  hapkit_put16(bytes + 9, (uint16_t)frame->duty);
  hapkit_put16(bytes + 11, hapkit_crc(bytes, 11));
}

/* Finds orders in what comes; begins with zeros. */
typedef struct hapkit_orders {
  uint8_t bytes[HAPKIT_ORDER_SIZE];
  uint8_t size;
  uint8_t refused; /* bytes that are no order have come */
} hapkit_orders;

/* 1 where this byte is the last of an order. What begins like one and is none costs a byte, so that one
   behind it is found. */
static inline uint8_t hapkit_take_byte(hapkit_orders* orders, uint8_t byte, hapkit_order* order) {
  uint8_t* const bytes = orders->bytes;
  bytes[orders->size++] = byte;
  if (orders->size == HAPKIT_ORDER_SIZE && bytes[0] == 0x5A) {
    const uint16_t told = (uint16_t)(bytes[4] | (uint16_t)bytes[5] << 8);
    if (told == hapkit_crc(bytes, 4)) {
      order->number = bytes[1];
      order->duty = (int16_t)(uint16_t)(bytes[2] | (uint16_t)bytes[3] << 8);
      orders->size = 0;
      return 1;
    }
  }
  while (orders->size == HAPKIT_ORDER_SIZE || (orders->size > 0 && bytes[0] != 0x5A)) {
    for (uint8_t i = 1; i < orders->size; ++i) bytes[i - 1] = bytes[i];
    --orders->size;
    orders->refused = 1;
  }
  return 0;
}

/* Counts half turns of the sensor; begins with zeros. As in the sketches of the course a step of more than
   700 counts is one, but from the last value that was a place, where they take the one before the last and
   none right after another: theirs count one too many where the sensor goes to and fro at an end. */
typedef struct hapkit_turns {
  uint16_t place;
  int8_t flips;
  uint8_t missed; /* values since then that were none */
  uint8_t has_begun;
} hapkit_turns;

/* 0, or HAPKIT_UNSURE: a step that no hand makes in that time and that is no half turn. The sensor was read
   while it went from one end to the other. */
static inline uint8_t hapkit_turn(hapkit_turns* turns, uint16_t sensor) {
  if (!turns->has_begun) turns->place = sensor;
  turns->has_begun = 1;
  const int16_t step = (int16_t)(sensor - turns->place);
  const int16_t most = (int16_t)(128 * (turns->missed + 1));
  if (step > 700 || step < -700) {
    turns->flips = (int8_t)(turns->flips + (step > 0 ? -1 : 1));
  } else if (step > most || step < -most) {
    ++turns->missed;
    return HAPKIT_UNSURE;
  }
  turns->place = sensor;
  turns->missed = 0;
  return 0;
}

/* The motor, and when it is let go. Begins as hapkit_at_rest. */
typedef struct hapkit_motor {
  int16_t duty;
  uint8_t order;
  uint8_t status; /* of what concerns it */
  uint8_t idle_ms;
} hapkit_motor;

static const hapkit_motor hapkit_at_rest = {0, 0, HAPKIT_LET_GO | HAPKIT_FRESH, HAPKIT_WATCHDOG_MS};

static inline void hapkit_obey(hapkit_motor* motor, const hapkit_order* order) {
  motor->duty = order->duty;
  motor->order = order->number;
  motor->status = 0;
  motor->idle_ms = 0;
  if (order->duty > HAPKIT_MOST_DUTY || order->duty < -HAPKIT_MOST_DUTY) {
    motor->duty = order->duty > 0 ? HAPKIT_MOST_DUTY : -HAPKIT_MOST_DUTY;
    motor->status = HAPKIT_SATURATED;
  }
}

/* A millisecond has passed. */
static inline void hapkit_wait(hapkit_motor* motor) {
  if (motor->idle_ms < HAPKIT_WATCHDOG_MS) ++motor->idle_ms;
  if (motor->idle_ms < HAPKIT_WATCHDOG_MS) return;
  motor->duty = 0;
  motor->status = (uint8_t)((motor->status & HAPKIT_FRESH) | HAPKIT_LET_GO);
}

#ifdef __cplusplus
}
#endif

#endif
