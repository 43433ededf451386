// The verbs of `orcart`: each adds its own subcommand with options, help and an example, and says how it
// ended.
#pragma once

#include <CLI/CLI.hpp>

#include "firmware-host/app/command_line.hpp"

namespace orcart {

/// Each verb sets `exit_code` in its callback: 0 only on success. Errors are one sentence on stderr.
void add_bench(CLI::App& app, int& exit_code);
void add_calibrate(CLI::App& app, int& exit_code);
void add_bench_paint(CLI::App& bench_verb, int& exit_code);  ///< a part of `bench`
void add_decode(CLI::App& app, int& exit_code);
void add_emulate(CLI::App& app, int& exit_code);
void add_evaluate(CLI::App& app, int& exit_code);
void add_evaluate_board(CLI::App& evaluate, int& exit_code);
void add_evaluate_map(CLI::App& evaluate, int& exit_code);
void add_evaluate_session(CLI::App& evaluate, int& exit_code);
void add_export(CLI::App& app, int& exit_code);
void add_latency(CLI::App& app, int& exit_code);
void add_paint(CLI::App& app, int& exit_code);
void add_probe(CLI::App& app, int& exit_code);
void add_hand_eye(CLI::App& calibrate, int& exit_code);
void add_medium(CLI::App& calibrate, int& exit_code);
void add_pivot(CLI::App& app, int& exit_code);
void add_rectify(CLI::App& app, int& exit_code);
void add_register(CLI::App& app, int& exit_code);
void add_time(CLI::App& calibrate, int& exit_code);
void add_turn(CLI::App& app, int& exit_code);
void add_turning(CLI::App& calibrate, int& exit_code);
void add_tip(CLI::App& calibrate, int& exit_code);
void add_surface(CLI::App& app, int& exit_code);

}  // namespace orcart
