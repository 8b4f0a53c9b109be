/* Driver of AspChip for a host: C99, no dependencies, no memory of its own. docs/host.md explains the chip.
 *
 * The caller fills in `struct asp_chip` up to `now` and calls asp_identify() first. Every function returns an enum
 * asp_error; ASP_OK is 0. Times are in the unit of `now`. */
#ifndef ASP_CHIP_H
#define ASP_CHIP_H

#include <stddef.h>
#include <stdint.h>

#include "asp_chip_registers.h"

#ifdef __cplusplus
extern "C" {
#endif

enum asp_error {
  ASP_OK,
  ASP_TRANSFER,  /* transfer() failed */
  ASP_IDENTITY,  /* no AspChip answers, or one with another register map */
  ASP_RANGE,     /* a value does not fit its field */
  ASP_READ_BACK, /* the configuration reads back otherwise than it was written */
  ASP_REFUSED,   /* the chip refused a write: a frame runs, or a loop-back byte waits, or loop_enable is in the way */
  ASP_WINDOW,    /* no frame: window inverted or outside the array, or nothing to read in it (cfg_err) */
  ASP_DURATION,  /* no frame: a duration is 0 (amp_err) */
  ASP_ABORTED,   /* the frame was aborted */
  ASP_TIMEOUT,   /* the limit has passed */
  ASP_LINK,      /* another byte than the expected one came from the link */
  ASP_ROOM       /* the frame does not fit the buffer */
};

#define ASP_MEMBER16(name, NAME) uint16_t name;
#define ASP_MEMBER32(name, NAME) uint32_t name;
#define ASP_MEMBER64(name, NAME) uint64_t name;

struct asp_identity { /* id, version, rows, cols ...: what a chip is */
  ASP_IDENTITY_FIELDS(ASP_MEMBER16)
};

struct asp_configuration { /* overlap, mode, threshold ...: a value of each field of this name, and the trims by type */
  ASP_CONFIGURATION_FIELDS(ASP_MEMBER32)
  int16_t trim[ASP_TRIMS];
};

struct asp_counters { /* cycles, conversions_made, conversions_left_out */
  ASP_COUNTER_FIELDS(ASP_MEMBER64)
};

struct asp_chip {
  void *context; /* passed to the functions below */
  /* One SPI transfer with csn low: n bytes out, and n in; `in` may be NULL. Returns 0, or not if it failed. */
  int (*transfer)(void *context, const uint8_t *out, uint8_t *in, size_t n);
  int (*link)(void *context);     /* the next byte that the link's receiver has, 0..255; -1: none */
  uint32_t (*now)(void *context); /* a clock that counts up and wraps */
  struct asp_identity identity;   /* asp_identify() fills it in */
};

/* Read who answers; ASP_IDENTITY where it is not a chip with the register map of this driver. */
int asp_identify(struct asp_chip *chip);

/* The configuration after a reset: every field's reset value, the whole array. */
void asp_defaults(const struct asp_chip *chip, struct asp_configuration *configuration);

/* Write the configuration, read it back, compare. Errors: RANGE (nothing was written), REFUSED, READ_BACK. */
int asp_configure(struct asp_chip *chip, const struct asp_configuration *configuration);

/* Start a frame. Error: REFUSED. */
int asp_start(struct asp_chip *chip);

/* Wait for the end of a frame without taking its bytes. Errors: WINDOW, DURATION, ABORTED, TIMEOUT (it still runs). */
int asp_wait(struct asp_chip *chip, uint32_t limit);

/* Start a frame and take its bytes: *length of them in buffer[room]. Bytes that the receiver holds before the start are
 * dropped. After TIMEOUT and ROOM the frame is aborted.
 * Errors: as start and wait, and ROOM. */
int asp_frame(struct asp_chip *chip, uint8_t *buffer, size_t room, size_t *length, uint32_t limit);

/* End the frame, drop a loop-back byte that waits. The bytes that the receiver holds are still there. */
int asp_abort(struct asp_chip *chip);

/* The status byte: bits ASP_BUSY_MASK, ASP_DONE_MASK ... */
int asp_status(struct asp_chip *chip, uint8_t *status);

/* All counters, in one transfer. */
int asp_counters(struct asp_chip *chip, struct asp_counters *counters);

/* Send bytes to loop_back and compare those that the link brings. limit: for each. After an error, a byte that waits is
 * dropped; loop_enable is clear again. Errors: REFUSED, TIMEOUT, LINK. */
int asp_loop_back(struct asp_chip *chip, const uint8_t *bytes, size_t n, uint32_t limit);

/* Write or read n bytes from an address on, n at most ASP_CONFIGURATION_SIZE. */
int asp_write(struct asp_chip *chip, uint8_t address, const uint8_t *bytes, size_t n);
int asp_read(struct asp_chip *chip, uint8_t address, uint8_t *bytes, size_t n);

#ifdef __cplusplus
}
#endif

#endif
