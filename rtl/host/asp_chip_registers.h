/* Registers of AspChip. Generated from models/parameters/registers/asp_chip.rdl by `talbot document`.
 *
 * Of each field: _ADDRESS of the byte with its lowest bit, _SHIFT of this bit there, _WIDTH in bits, _DEFAULT after a
 * reset, and of a field in one byte _MASK, its bits there.
 * A field of more than a byte is little-endian. Meaning and access: docs/registers.md, docs/host.md. */
#ifndef ASP_CHIP_REGISTERS_H
#define ASP_CHIP_REGISTERS_H

#define ASP_WRITE 0x80u /* bit 7 of a transfer's first byte; the others are the address */
#define ASP_ADDRESS_MAX 0x7fu /* the address stops counting here */

#define ASP_CONFIGURATION_ADDRESS 0x04u
#define ASP_CONFIGURATION_SIZE 78u
#define ASP_COUNTERS_ADDRESS 0x58u
#define ASP_COUNTERS_SIZE 24u
#define ASP_TRIMS 24u /* ASP_TRIM_* is that of pixel type 0 */
#define ASP_TRIM_SIZE 2u /* bytes from one to the next */

/* Constants of a chip, ascending: FIELD(name, stem of its macros) */
#define ASP_IDENTITY_FIELDS(FIELD) \
    FIELD(id, ID) \
    FIELD(version, VERSION) \
    FIELD(stepping, STEPPING) \
    FIELD(lanes, LANES) \
    FIELD(rows, ROWS) \
    FIELD(cols, COLS) \
    FIELD(tile_rows, TILE_ROWS) \
    FIELD(tile_cols, TILE_COLS) \
    FIELD(divider, DIVIDER)

/* The configuration but the trims, ascending: FIELD(name, stem of its macros) */
#define ASP_CONFIGURATION_FIELDS(FIELD) \
    FIELD(overlap, OVERLAP) \
    FIELD(phase, PHASE) \
    FIELD(test_pattern, TEST_PATTERN) \
    FIELD(loop_enable, LOOP_ENABLE) \
    FIELD(resync, RESYNC) \
    FIELD(mode, MODE) \
    FIELD(decimation, DECIMATION) \
    FIELD(threshold, THRESHOLD) \
    FIELD(noise_floor, NOISE_FLOOR) \
    FIELD(mask, MASK) \
    FIELD(row0, ROW0) \
    FIELD(row1, ROW1) \
    FIELD(col0, COL0) \
    FIELD(col1, COL1) \
    FIELD(frame_number, FRAME_NUMBER) \
    FIELD(n_cm, N_CM) \
    FIELD(calibration, CALIBRATION) \
    FIELD(t_reset, T_RESET) \
    FIELD(t_int, T_INT) \
    FIELD(t_cm, T_CM) \
    FIELD(t_settle, T_SETTLE) \
    FIELD(t_read, T_READ) \
    FIELD(t_guard, T_GUARD) \
    FIELD(exposure, EXPOSURE)

/* The counters, ascending: FIELD(name, stem of its macros) */
#define ASP_COUNTER_FIELDS(FIELD) \
    FIELD(cycles, CYCLES) \
    FIELD(conversions_made, CONVERSIONS_MADE) \
    FIELD(conversions_left_out, CONVERSIONS_LEFT_OUT)


/* id (ro): Which chip answers: 0x54, 'T'. */
#define ASP_ID_ADDRESS 0x00u
#define ASP_ID_SHIFT 0u
#define ASP_ID_WIDTH 8u
#define ASP_ID_DEFAULT 0x54u
#define ASP_ID_MASK 0xffu

/* version (ro): Version of this map; counts up with every change. */
#define ASP_VERSION_ADDRESS 0x01u
#define ASP_VERSION_SHIFT 0u
#define ASP_VERSION_WIDTH 8u
#define ASP_VERSION_DEFAULT 0x6u
#define ASP_VERSION_MASK 0xffu

/* start (wo): 1 starts a frame; refused while one runs, while `loop_enable` is set and together with `abort`. */
#define ASP_START_ADDRESS 0x02u
#define ASP_START_SHIFT 0u
#define ASP_START_WIDTH 1u
#define ASP_START_DEFAULT 0x0u
#define ASP_START_MASK 0x01u

/* abort (wo): 1 ends the frame and drops a loop-back byte that waits; the configuration stays. */
#define ASP_ABORT_ADDRESS 0x02u
#define ASP_ABORT_SHIFT 1u
#define ASP_ABORT_WIDTH 1u
#define ASP_ABORT_DEFAULT 0x0u
#define ASP_ABORT_MASK 0x02u

/* busy (ro): A frame runs, or its last bytes wait for the link. */
#define ASP_BUSY_ADDRESS 0x03u
#define ASP_BUSY_SHIFT 0u
#define ASP_BUSY_WIDTH 1u
#define ASP_BUSY_DEFAULT 0x0u
#define ASP_BUSY_MASK 0x01u

/* done (w1c): A frame ended. */
#define ASP_DONE_ADDRESS 0x03u
#define ASP_DONE_SHIFT 1u
#define ASP_DONE_WIDTH 1u
#define ASP_DONE_DEFAULT 0x0u
#define ASP_DONE_MASK 0x02u

/* cfg_err (w1c): No frame started: nothing to read, or the window is inverted or out of range. */
#define ASP_CFG_ERR_ADDRESS 0x03u
#define ASP_CFG_ERR_SHIFT 2u
#define ASP_CFG_ERR_WIDTH 1u
#define ASP_CFG_ERR_DEFAULT 0x0u
#define ASP_CFG_ERR_MASK 0x04u

/* amp_err (w1c): The amplifier control refused a zero duration. */
#define ASP_AMP_ERR_ADDRESS 0x03u
#define ASP_AMP_ERR_SHIFT 3u
#define ASP_AMP_ERR_WIDTH 1u
#define ASP_AMP_ERR_DEFAULT 0x0u
#define ASP_AMP_ERR_MASK 0x08u

/* refused (w1c): A write was refused: configuration while it is locked, a start, or a loop-back byte without */
/* `loop_enable` or before the one ahead of it left. */
#define ASP_REFUSED_ADDRESS 0x03u
#define ASP_REFUSED_SHIFT 4u
#define ASP_REFUSED_WIDTH 1u
#define ASP_REFUSED_DEFAULT 0x0u
#define ASP_REFUSED_MASK 0x10u

/* aborted (w1c): An abort was written. */
#define ASP_ABORTED_ADDRESS 0x03u
#define ASP_ABORTED_SHIFT 5u
#define ASP_ABORTED_WIDTH 1u
#define ASP_ABORTED_DEFAULT 0x0u
#define ASP_ABORTED_MASK 0x20u

/* overlap (rw): Integrate the next row while this one converts. */
#define ASP_OVERLAP_ADDRESS 0x04u
#define ASP_OVERLAP_SHIFT 0u
#define ASP_OVERLAP_WIDTH 1u
#define ASP_OVERLAP_DEFAULT 0x1u
#define ASP_OVERLAP_MASK 0x01u

/* phase (rw): In tof mode, send (phase, amplitude) instead of the taps; no effect without a phase path. */
#define ASP_PHASE_ADDRESS 0x04u
#define ASP_PHASE_SHIFT 1u
#define ASP_PHASE_WIDTH 1u
#define ASP_PHASE_DEFAULT 0x0u
#define ASP_PHASE_MASK 0x02u

/* test_pattern (rw): A digital pattern instead of the comparators. */
#define ASP_TEST_PATTERN_ADDRESS 0x04u
#define ASP_TEST_PATTERN_SHIFT 2u
#define ASP_TEST_PATTERN_WIDTH 1u
#define ASP_TEST_PATTERN_DEFAULT 0x0u
#define ASP_TEST_PATTERN_MASK 0x04u

/* loop_enable (rw): The link carries the bytes written to `loop_back`. */
#define ASP_LOOP_ENABLE_ADDRESS 0x04u
#define ASP_LOOP_ENABLE_SHIFT 3u
#define ASP_LOOP_ENABLE_WIDTH 1u
#define ASP_LOOP_ENABLE_DEFAULT 0x0u
#define ASP_LOOP_ENABLE_MASK 0x08u

/* resync (rw): A mark follows the first row that ends 64 times this many bytes, or more, behind the mark before */
/* (0: every row). */
#define ASP_RESYNC_ADDRESS 0x04u
#define ASP_RESYNC_SHIFT 4u
#define ASP_RESYNC_WIDTH 2u
#define ASP_RESYNC_DEFAULT 0x2u
#define ASP_RESYNC_MASK 0x30u

/* mode (rw): What a frame converts and sends (5 to 7 are as 1 to 3): 0 edge (difference of the diodes), 1 image */
/* (their sum), 2 raw (both diodes), 3 tof (four taps), 4 ternary (sign of the difference, or 0 under the */
/* threshold: no conversion). */
#define ASP_MODE_ADDRESS 0x05u
#define ASP_MODE_SHIFT 0u
#define ASP_MODE_WIDTH 3u
#define ASP_MODE_DEFAULT 0x0u
#define ASP_MODE_MASK 0x07u
enum asp_mode { ASP_MODE_EDGE = 0, ASP_MODE_IMAGE = 1, ASP_MODE_RAW = 2, ASP_MODE_TOF = 3, ASP_MODE_TERNARY = 4 };

/* decimation (rw): log2 of the tile step, from the window's corner. */
#define ASP_DECIMATION_ADDRESS 0x05u
#define ASP_DECIMATION_SHIFT 4u
#define ASP_DECIMATION_WIDTH 2u
#define ASP_DECIMATION_DEFAULT 0x0u
#define ASP_DECIMATION_MASK 0x30u

/* threshold (rw): Edge and ternary mode: codes under it in magnitude are exact zeros; 0 converts everything of */
/* edge mode. */
#define ASP_THRESHOLD_ADDRESS 0x06u
#define ASP_THRESHOLD_SHIFT 0u
#define ASP_THRESHOLD_WIDTH 7u
#define ASP_THRESHOLD_DEFAULT 0xau
#define ASP_THRESHOLD_MASK 0x7fu

/* noise_floor (rw): Amplitude under which a phase is not valid. */
#define ASP_NOISE_FLOOR_ADDRESS 0x07u
#define ASP_NOISE_FLOOR_SHIFT 0u
#define ASP_NOISE_FLOOR_WIDTH 8u
#define ASP_NOISE_FLOOR_DEFAULT 0x0u
#define ASP_NOISE_FLOOR_MASK 0xffu

/* mask (rw): Bit t set: pixel type t is read. */
#define ASP_MASK_ADDRESS 0x08u
#define ASP_MASK_SHIFT 0u
#define ASP_MASK_WIDTH 24u
#define ASP_MASK_DEFAULT 0xffffffu

/* row0 (rw): First tile row of the window. */
#define ASP_ROW0_ADDRESS 0x0cu
#define ASP_ROW0_SHIFT 0u
#define ASP_ROW0_WIDTH 8u
#define ASP_ROW0_DEFAULT 0x0u
#define ASP_ROW0_MASK 0xffu

/* row1 (rw): Last tile row; resets to the array's last. */
#define ASP_ROW1_ADDRESS 0x0du
#define ASP_ROW1_SHIFT 0u
#define ASP_ROW1_WIDTH 8u
#define ASP_ROW1_DEFAULT 0x5fu
#define ASP_ROW1_MASK 0xffu

/* col0 (rw): First tile column of the window. */
#define ASP_COL0_ADDRESS 0x0eu
#define ASP_COL0_SHIFT 0u
#define ASP_COL0_WIDTH 8u
#define ASP_COL0_DEFAULT 0x0u
#define ASP_COL0_MASK 0xffu

/* col1 (rw): Last tile column; resets to the array's last. */
#define ASP_COL1_ADDRESS 0x0fu
#define ASP_COL1_SHIFT 0u
#define ASP_COL1_WIDTH 8u
#define ASP_COL1_DEFAULT 0x3fu
#define ASP_COL1_MASK 0xffu

/* frame_number (rw): Any number; it goes into the frame's header. */
#define ASP_FRAME_NUMBER_ADDRESS 0x10u
#define ASP_FRAME_NUMBER_SHIFT 0u
#define ASP_FRAME_NUMBER_WIDTH 16u
#define ASP_FRAME_NUMBER_DEFAULT 0x0u

/* n_cm (rw): Common-mode resets a row, 0..255. */
#define ASP_N_CM_ADDRESS 0x12u
#define ASP_N_CM_SHIFT 0u
#define ASP_N_CM_WIDTH 8u
#define ASP_N_CM_DEFAULT 0x0u
#define ASP_N_CM_MASK 0xffu

/* calibration (rw): The host's number for its trims, gain and clock; it goes into the frame's header. */
#define ASP_CALIBRATION_ADDRESS 0x13u
#define ASP_CALIBRATION_SHIFT 0u
#define ASP_CALIBRATION_WIDTH 8u
#define ASP_CALIBRATION_DEFAULT 0x0u
#define ASP_CALIBRATION_MASK 0xffu

/* t_reset (rw): Pixel reset, cycles, 1..65535. */
#define ASP_T_RESET_ADDRESS 0x14u
#define ASP_T_RESET_SHIFT 0u
#define ASP_T_RESET_WIDTH 16u
#define ASP_T_RESET_DEFAULT 0x20u

/* t_int (rw): Each integration, cycles, 1..65535. */
#define ASP_T_INT_ADDRESS 0x16u
#define ASP_T_INT_SHIFT 0u
#define ASP_T_INT_WIDTH 16u
#define ASP_T_INT_DEFAULT 0x200u

/* t_cm (rw): Each common-mode reset, cycles, 1..65535. */
#define ASP_T_CM_ADDRESS 0x18u
#define ASP_T_CM_SHIFT 0u
#define ASP_T_CM_WIDTH 16u
#define ASP_T_CM_DEFAULT 0x10u

/* t_settle (rw): Reference level before the signal, cycles, 1..65535. */
#define ASP_T_SETTLE_ADDRESS 0x1au
#define ASP_T_SETTLE_SHIFT 0u
#define ASP_T_SETTLE_WIDTH 16u
#define ASP_T_SETTLE_DEFAULT 0x10u

/* t_read (rw): Read of the signal, cycles, 1..65535. */
#define ASP_T_READ_ADDRESS 0x1cu
#define ASP_T_READ_SHIFT 0u
#define ASP_T_READ_WIDTH 16u
#define ASP_T_READ_DEFAULT 0x10u

/* t_guard (rw): Guard between any two phases, cycles, 1..65535. */
#define ASP_T_GUARD_ADDRESS 0x1eu
#define ASP_T_GUARD_SHIFT 0u
#define ASP_T_GUARD_WIDTH 16u
#define ASP_T_GUARD_DEFAULT 0x2u

/* trim (rw): Flat-field trim of one pixel type, signed: capacitor ratio 1 + trim / 512. */
#define ASP_TRIM_ADDRESS 0x20u
#define ASP_TRIM_SHIFT 0u
#define ASP_TRIM_WIDTH 10u
#define ASP_TRIM_DEFAULT 0x0u

/* exposure (rw): Rows by which the reset pointer leads the read pointer, 0..1023; not in tof mode. */
#define ASP_EXPOSURE_ADDRESS 0x50u
#define ASP_EXPOSURE_SHIFT 0u
#define ASP_EXPOSURE_WIDTH 10u
#define ASP_EXPOSURE_DEFAULT 0x0u

/* cycles (ro): Clock cycles from the start to the sequencer's last message. */
#define ASP_CYCLES_ADDRESS 0x58u
#define ASP_CYCLES_SHIFT 0u
#define ASP_CYCLES_WIDTH 64u
#define ASP_CYCLES_DEFAULT 0x0u

/* conversions_made (ro): Samples that took a full conversion. */
#define ASP_CONVERSIONS_MADE_ADDRESS 0x60u
#define ASP_CONVERSIONS_MADE_SHIFT 0u
#define ASP_CONVERSIONS_MADE_WIDTH 64u
#define ASP_CONVERSIONS_MADE_DEFAULT 0x0u

/* conversions_left_out (ro): Samples that the window comparison made an exact zero. */
#define ASP_CONVERSIONS_LEFT_OUT_ADDRESS 0x68u
#define ASP_CONVERSIONS_LEFT_OUT_SHIFT 0u
#define ASP_CONVERSIONS_LEFT_OUT_WIDTH 64u
#define ASP_CONVERSIONS_LEFT_OUT_DEFAULT 0x0u

/* amp_state (ro): Amplifier control. 0 idle (no row), 1 guard (all phases low), 2 pixel_reset (pixel reset), 3 */
/* integrate (integration), 4 cm_reset (common-mode reset), 5 reference_level (read, reference level), 6 */
/* signal_level (read, signal). */
#define ASP_AMP_STATE_ADDRESS 0x70u
#define ASP_AMP_STATE_SHIFT 0u
#define ASP_AMP_STATE_WIDTH 3u
#define ASP_AMP_STATE_DEFAULT 0x0u
#define ASP_AMP_STATE_MASK 0x07u
enum asp_amp_state { ASP_AMP_STATE_IDLE = 0, ASP_AMP_STATE_GUARD = 1, ASP_AMP_STATE_PIXEL_RESET = 2, ASP_AMP_STATE_INTEGRATE = 3, ASP_AMP_STATE_CM_RESET = 4, ASP_AMP_STATE_REFERENCE_LEVEL = 5, ASP_AMP_STATE_SIGNAL_LEVEL = 6 };

/* seq_state (ro): Sequencer. 0 idle (no frame), 1 check (a frame starts), 2 wait (for the amplifiers), 3 drain */
/* (the converters end a row), 4 frame (offers the frame's start), 5 row (offers a row), 6 sample (offers a */
/* sample), 7 end (offers the frame's end). */
#define ASP_SEQ_STATE_ADDRESS 0x70u
#define ASP_SEQ_STATE_SHIFT 4u
#define ASP_SEQ_STATE_WIDTH 3u
#define ASP_SEQ_STATE_DEFAULT 0x0u
#define ASP_SEQ_STATE_MASK 0x70u
enum asp_seq_state { ASP_SEQ_STATE_IDLE = 0, ASP_SEQ_STATE_CHECK = 1, ASP_SEQ_STATE_WAIT = 2, ASP_SEQ_STATE_DRAIN = 3, ASP_SEQ_STATE_FRAME = 4, ASP_SEQ_STATE_ROW = 5, ASP_SEQ_STATE_SAMPLE = 6, ASP_SEQ_STATE_END = 7 };

/* encoder_state (ro): Encoder. 0 idle (no frame), 1 header (sends the header), 2 rows (sends samples), 3 mark */
/* (sends a mark), 4 trailer (sends the trailer), 5 drain (the last bytes wait). */
#define ASP_ENCODER_STATE_ADDRESS 0x71u
#define ASP_ENCODER_STATE_SHIFT 0u
#define ASP_ENCODER_STATE_WIDTH 3u
#define ASP_ENCODER_STATE_DEFAULT 0x0u
#define ASP_ENCODER_STATE_MASK 0x07u
enum asp_encoder_state { ASP_ENCODER_STATE_IDLE = 0, ASP_ENCODER_STATE_HEADER = 1, ASP_ENCODER_STATE_ROWS = 2, ASP_ENCODER_STATE_MARK = 3, ASP_ENCODER_STATE_TRAILER = 4, ASP_ENCODER_STATE_DRAIN = 5 };

/* hold_taken (ro): The sample-and-hold is taken by the row that converts: the next row waits before its read. */
#define ASP_HOLD_TAKEN_ADDRESS 0x72u
#define ASP_HOLD_TAKEN_SHIFT 0u
#define ASP_HOLD_TAKEN_WIDTH 1u
#define ASP_HOLD_TAKEN_DEFAULT 0x0u
#define ASP_HOLD_TAKEN_MASK 0x01u

/* converting (ro): A converter works. */
#define ASP_CONVERTING_ADDRESS 0x72u
#define ASP_CONVERTING_SHIFT 1u
#define ASP_CONVERTING_WIDTH 1u
#define ASP_CONVERTING_DEFAULT 0x0u
#define ASP_CONVERTING_MASK 0x02u

/* step_waits (ro): The sequencer's message waits for the converters. */
#define ASP_STEP_WAITS_ADDRESS 0x72u
#define ASP_STEP_WAITS_SHIFT 2u
#define ASP_STEP_WAITS_WIDTH 1u
#define ASP_STEP_WAITS_DEFAULT 0x0u
#define ASP_STEP_WAITS_MASK 0x04u

/* scan_waits (ro): A sample or mark of the converters waits for the phase path. */
#define ASP_SCAN_WAITS_ADDRESS 0x72u
#define ASP_SCAN_WAITS_SHIFT 3u
#define ASP_SCAN_WAITS_WIDTH 1u
#define ASP_SCAN_WAITS_DEFAULT 0x0u
#define ASP_SCAN_WAITS_MASK 0x08u

/* link_waits (ro): A byte waits for `link_rdy`. */
#define ASP_LINK_WAITS_ADDRESS 0x72u
#define ASP_LINK_WAITS_SHIFT 4u
#define ASP_LINK_WAITS_WIDTH 1u
#define ASP_LINK_WAITS_DEFAULT 0x0u
#define ASP_LINK_WAITS_MASK 0x10u

/* loop_waits (ro): A byte of `loop_back` waits for the link; the configuration is locked. */
#define ASP_LOOP_WAITS_ADDRESS 0x72u
#define ASP_LOOP_WAITS_SHIFT 5u
#define ASP_LOOP_WAITS_WIDTH 1u
#define ASP_LOOP_WAITS_DEFAULT 0x0u
#define ASP_LOOP_WAITS_MASK 0x20u

/* stepping (ro): Mask set of the chip. */
#define ASP_STEPPING_ADDRESS 0x74u
#define ASP_STEPPING_SHIFT 0u
#define ASP_STEPPING_WIDTH 8u
#define ASP_STEPPING_DEFAULT 0x0u
#define ASP_STEPPING_MASK 0xffu

/* lanes (ro): Converters. */
#define ASP_LANES_ADDRESS 0x75u
#define ASP_LANES_SHIFT 0u
#define ASP_LANES_WIDTH 8u
#define ASP_LANES_DEFAULT 0x8u
#define ASP_LANES_MASK 0xffu

/* rows (ro): Pixel rows of the array. */
#define ASP_ROWS_ADDRESS 0x76u
#define ASP_ROWS_SHIFT 0u
#define ASP_ROWS_WIDTH 16u
#define ASP_ROWS_DEFAULT 0x180u

/* cols (ro): Pixel columns of the array. */
#define ASP_COLS_ADDRESS 0x78u
#define ASP_COLS_SHIFT 0u
#define ASP_COLS_WIDTH 16u
#define ASP_COLS_DEFAULT 0x180u

/* tile_rows (ro): Pixel rows of a tile. */
#define ASP_TILE_ROWS_ADDRESS 0x7au
#define ASP_TILE_ROWS_SHIFT 0u
#define ASP_TILE_ROWS_WIDTH 8u
#define ASP_TILE_ROWS_DEFAULT 0x4u
#define ASP_TILE_ROWS_MASK 0xffu

/* tile_cols (ro): Pixel columns of a tile. */
#define ASP_TILE_COLS_ADDRESS 0x7bu
#define ASP_TILE_COLS_SHIFT 0u
#define ASP_TILE_COLS_WIDTH 8u
#define ASP_TILE_COLS_DEFAULT 0x6u
#define ASP_TILE_COLS_MASK 0xffu

/* divider (ro): Divider of the phase path. 0 radix2 (restoring), 1 radix4 (restoring, two bits a cycle), 2 */
/* pipelined (one result a cycle), 3 cordic (CORDIC), 4 none (no phase path). */
#define ASP_DIVIDER_ADDRESS 0x7cu
#define ASP_DIVIDER_SHIFT 0u
#define ASP_DIVIDER_WIDTH 3u
#define ASP_DIVIDER_DEFAULT 0x1u
#define ASP_DIVIDER_MASK 0x07u
enum asp_divider { ASP_DIVIDER_RADIX2 = 0, ASP_DIVIDER_RADIX4 = 1, ASP_DIVIDER_PIPELINED = 2, ASP_DIVIDER_CORDIC = 3, ASP_DIVIDER_NONE = 4 };

/* loop_back (wo): A byte for the link, when `loop_enable` is set. The address stays here, so that one transfer */
/* may carry many. */
#define ASP_LOOP_BACK_ADDRESS 0x7fu
#define ASP_LOOP_BACK_SHIFT 0u
#define ASP_LOOP_BACK_WIDTH 8u
#define ASP_LOOP_BACK_DEFAULT 0x0u
#define ASP_LOOP_BACK_MASK 0xffu

#endif
