#include "asp_chip.h"

#include <string.h>

/* A field of at most 64 bits in the bytes from its address on. */
struct field {
  uint8_t address, shift, width;
};
#define FIELD_OF(NAME) {ASP_##NAME##_ADDRESS, ASP_##NAME##_SHIFT, ASP_##NAME##_WIDTH}
#define AT(NAME) (ASP_##NAME##_ADDRESS - ASP_CONFIGURATION_ADDRESS)

static uint64_t mask(struct field f) { return ~(uint64_t)0 >> (64 - f.width); }

static size_t bytes_of(struct field f) { return (f.shift + f.width + 7u) / 8u; }

static uint64_t get(const uint8_t *bytes, struct field f) {
  uint64_t value = 0;
  for (size_t i = bytes_of(f); i-- > 0;) value = value << 8 | bytes[i];
  return value >> f.shift & mask(f);
}

/* Put a value into bytes; ASP_RANGE if it has more bits than the field. */
static int put(uint8_t *bytes, struct field f, uint64_t value) {
  if (value & ~mask(f)) return ASP_RANGE;
  value <<= f.shift;
  for (size_t i = 0; i < bytes_of(f); ++i) bytes[i] |= (uint8_t)(value >> 8 * i);
  return ASP_OK;
}

int asp_write(struct asp_chip *chip, uint8_t address, const uint8_t *bytes, size_t n) {
  uint8_t out[1 + ASP_CONFIGURATION_SIZE];
  if (n > ASP_CONFIGURATION_SIZE) return ASP_RANGE;
  out[0] = ASP_WRITE | address;
  memcpy(out + 1, bytes, n);
  return chip->transfer(chip->context, out, NULL, 1 + n) ? ASP_TRANSFER : ASP_OK;
}

int asp_read(struct asp_chip *chip, uint8_t address, uint8_t *bytes, size_t n) {
  uint8_t out[1 + ASP_CONFIGURATION_SIZE] = {0}, in[1 + ASP_CONFIGURATION_SIZE];
  if (n > ASP_CONFIGURATION_SIZE) return ASP_RANGE;
  out[0] = address;
  if (chip->transfer(chip->context, out, in, 1 + n)) return ASP_TRANSFER;
  memcpy(bytes, in + 1, n);
  return ASP_OK;
}

static int write_byte(struct asp_chip *chip, uint8_t address, uint8_t byte) {
  return asp_write(chip, address, &byte, 1);
}

int asp_status(struct asp_chip *chip, uint8_t *status) { return asp_read(chip, ASP_BUSY_ADDRESS, status, 1); }

/* Whether the chip refused a write since `refused` was cleared. */
static int refused(struct asp_chip *chip) {
  uint8_t status;
  const int error = asp_status(chip, &status);
  return error ? error : status & ASP_REFUSED_MASK ? ASP_REFUSED : ASP_OK;
}

/* A write that the chip may refuse. */
static int write_checked(struct asp_chip *chip, uint8_t address, const uint8_t *bytes, size_t n) {
  int error = write_byte(chip, ASP_REFUSED_ADDRESS, ASP_REFUSED_MASK);
  if (!error) error = asp_write(chip, address, bytes, n);
  return error ? error : refused(chip);
}

int asp_identify(struct asp_chip *chip) {
  const struct field fields[] = {
#define ENTRY(name, NAME) FIELD_OF(NAME),
      ASP_IDENTITY_FIELDS(ENTRY)};
  uint16_t *value[] = {
#define MEMBER(name, NAME) &chip->identity.name,
      ASP_IDENTITY_FIELDS(MEMBER)};
  uint8_t bytes[2];
  for (size_t i = 0; i < sizeof fields / sizeof *fields; ++i) {
    const int error = asp_read(chip, fields[i].address, bytes, bytes_of(fields[i]));
    if (error) return error;
    *value[i] = (uint16_t)get(bytes, fields[i]);
  }
  return chip->identity.id == ASP_ID_DEFAULT && chip->identity.version == ASP_VERSION_DEFAULT ? ASP_OK : ASP_IDENTITY;
}

void asp_defaults(const struct asp_chip *chip, struct asp_configuration *configuration) {
  memset(configuration, 0, sizeof *configuration);
#define DEFAULT(name, NAME) configuration->name = ASP_##NAME##_DEFAULT;
  ASP_CONFIGURATION_FIELDS(DEFAULT)
  configuration->row1 = (chip->identity.rows - 1u) / chip->identity.tile_rows;
  configuration->col1 = (chip->identity.cols - 1u) / chip->identity.tile_cols;
}

int asp_configure(struct asp_chip *chip, const struct asp_configuration *configuration) {
  uint8_t bytes[ASP_CONFIGURATION_SIZE] = {0}, back[ASP_CONFIGURATION_SIZE];
  int error = ASP_OK;
#define PUT(name, NAME) \
  if (!error) error = put(bytes + AT(NAME), (struct field)FIELD_OF(NAME), configuration->name);
  ASP_CONFIGURATION_FIELDS(PUT)
  for (size_t t = 0; t < ASP_TRIMS && !error; ++t) {
    const struct field trim = FIELD_OF(TRIM);
    const int16_t value = configuration->trim[t], half = 1 << (trim.width - 1);
    if (value < -half || value >= half) return ASP_RANGE;
    error = put(bytes + AT(TRIM) + ASP_TRIM_SIZE * t, trim, (uint64_t)value & mask(trim));
  }
  if (!error) error = write_checked(chip, ASP_CONFIGURATION_ADDRESS, bytes, sizeof bytes);
  if (!error) error = asp_read(chip, ASP_CONFIGURATION_ADDRESS, back, sizeof back);
  if (!error && memcmp(bytes, back, sizeof back)) error = ASP_READ_BACK;
  return error;
}

int asp_start(struct asp_chip *chip) {
  const uint8_t start = ASP_START_MASK;
  return write_checked(chip, ASP_START_ADDRESS, &start, 1);
}

int asp_abort(struct asp_chip *chip) { return write_byte(chip, ASP_ABORT_ADDRESS, ASP_ABORT_MASK); }

/* Drop what the receiver holds. */
static void drain(struct asp_chip *chip) {
  while (chip->link(chip->context) >= 0) {}
}

/* Take bytes, where there is a buffer, until the frame has ended. */
static int follow(struct asp_chip *chip, uint8_t *buffer, size_t room, size_t *length, uint32_t limit) {
  const uint32_t since = chip->now(chip->context);
  for (;;) {
    uint8_t status;
    const int late = chip->now(chip->context) - since > limit, error = asp_status(chip, &status);
    if (error) return error;
    for (int byte; buffer && (byte = chip->link(chip->context)) >= 0;) {
      if (*length == room) return ASP_ROOM;
      buffer[(*length)++] = (uint8_t)byte;
    }
    if (status & ASP_DONE_MASK) return ASP_OK;
    if (status & ASP_ABORTED_MASK) return ASP_ABORTED;
    if (status & ASP_AMP_ERR_MASK) return ASP_DURATION;
    if (status & ASP_CFG_ERR_MASK) return ASP_WINDOW;
    if (late) return ASP_TIMEOUT;
  }
}

int asp_wait(struct asp_chip *chip, uint32_t limit) { return follow(chip, NULL, 0, NULL, limit); }

int asp_frame(struct asp_chip *chip, uint8_t *buffer, size_t room, size_t *length, uint32_t limit) {
  int error;
  drain(chip);
  error = asp_start(chip);
  *length = 0;
  if (!error) error = follow(chip, buffer, room, length, limit);
  if (error == ASP_TIMEOUT || error == ASP_ROOM) (void)asp_abort(chip);
  return error;
}

int asp_counters(struct asp_chip *chip, struct asp_counters *counters) {
  uint8_t bytes[ASP_COUNTERS_SIZE] = {0};
  const int error = asp_read(chip, ASP_COUNTERS_ADDRESS, bytes, sizeof bytes);
#define COUNTER(name, NAME) \
  counters->name = get(bytes + ASP_##NAME##_ADDRESS - ASP_COUNTERS_ADDRESS, (struct field)FIELD_OF(NAME));
  ASP_COUNTER_FIELDS(COUNTER)
  return error;
}

static int enable_loop(struct asp_chip *chip, int on) {
  uint8_t options;
  const int error = asp_read(chip, ASP_LOOP_ENABLE_ADDRESS, &options, 1);
  if (error) return error;
  options = (uint8_t)(on ? options | ASP_LOOP_ENABLE_MASK : options & ~ASP_LOOP_ENABLE_MASK);
  return write_checked(chip, ASP_LOOP_ENABLE_ADDRESS, &options, 1);
}

static int loop_byte(struct asp_chip *chip, uint8_t byte, uint32_t limit) {
  int got, error = write_checked(chip, ASP_LOOP_BACK_ADDRESS, &byte, 1);
  const uint32_t since = chip->now(chip->context);
  while (!error && (got = chip->link(chip->context)) != byte) {
    if (got >= 0) error = ASP_LINK;
    else if (chip->now(chip->context) - since > limit) error = ASP_TIMEOUT;
  }
  return error;
}

int asp_loop_back(struct asp_chip *chip, const uint8_t *bytes, size_t n, uint32_t limit) {
  int error = enable_loop(chip, 1), end;
  if (error) return error;
  drain(chip);
  for (size_t i = 0; i < n && !error; ++i) error = loop_byte(chip, bytes[i], limit);
  if (error) (void)asp_abort(chip);
  end = enable_loop(chip, 0);
  return error ? error : end;
}
