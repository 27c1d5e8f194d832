// SPDX-License-Identifier: Apache-2.0
// A Hapkit whose force is the computer's: 1000 frames a second with the place of its sensor, orders for its motor back, and nothing
// pushes any more 20 ms after the last order. README.md has wiring, bytes and limits. Of Kerf; no code of the Hapkit's makers.

#include "frame.h"

namespace {

constexpr uint8_t sensor_pin = A2;
constexpr uint8_t strength_pin = 5;   // a PWM of timer 0
constexpr uint8_t direction_pin = 8;  // high: the other way

volatile uint16_t ticks = 0;  // of 1 ms
uint16_t done = 0;
hapkit_orders orders = {};
hapkit_turns turns = {};
hapkit_motor motor = hapkit_at_rest;
int16_t pushes = 0;

void push(int16_t duty) {
  if (duty == pushes) return;
  if ((duty < 0) != (pushes < 0)) analogWrite(strength_pin, 0);  // it never turns round at full strength
  digitalWrite(direction_pin, duty < 0 ? HIGH : LOW);
  analogWrite(strength_pin, duty < 0 ? -duty : duty);
  pushes = duty;
}

void tell() {
  hapkit_frame frame;
  frame.count = done;
  frame.sensor = static_cast<uint16_t>(analogRead(sensor_pin));
  frame.status = static_cast<uint8_t>(hapkit_turn(&turns, frame.sensor) | motor.status);
  if (orders.refused) frame.status |= HAPKIT_REFUSED;
  orders.refused = 0;
  frame.flips = turns.flips;
  frame.order = motor.order;
  frame.duty = motor.duty;
  uint8_t bytes[HAPKIT_FRAME_SIZE];
  hapkit_put_frame(&frame, bytes);
  // On a line that is full it would wait, and the watchdog with it: the host sees by the count what is missing.
  if (Serial.availableForWrite() >= HAPKIT_FRAME_SIZE) Serial.write(bytes, sizeof bytes);
}

}  // namespace

ISR(TIMER1_COMPA_vect) { ++ticks; }

void setup() {
  pinMode(strength_pin, OUTPUT);
  pinMode(direction_pin, OUTPUT);
  digitalWrite(strength_pin, LOW);
  TIMSK0 = 0;                                              // no millis(): at 62.5 kHz it would take a fifth of the time
  TCCR0B = static_cast<uint8_t>((TCCR0B & 0xF8) | _BV(CS00));  // 16 MHz / 256 = 62.5 kHz
  TCCR1A = 0;
  TCCR1B = _BV(WGM12) | _BV(CS11);  // 16 MHz / 8 = 2 MHz, begun anew after
  OCR1A = 1999;                     // 2000 of them: 1 kHz
  TIMSK1 = _BV(OCIE1A);
  Serial.begin(HAPKIT_BAUD);
}

void loop() {
  while (Serial.available() > 0) {
    hapkit_order order;
    if (hapkit_take_byte(&orders, static_cast<uint8_t>(Serial.read()), &order)) hapkit_obey(&motor, &order);
  }
  push(motor.duty);
  noInterrupts();
  const uint16_t now = ticks;
  interrupts();
  if (done == now) return;
  for (; done != now; ++done) hapkit_wait(&motor);
  push(motor.duty);
  tell();
}
