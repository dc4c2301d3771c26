// SPDX-License-Identifier: MIT
#include "meltray/app/command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "meltray/app/commands.hpp"
#include "meltray/core/errors.hpp"
#include "meltray/core/nearest.hpp"
#include "meltray/observe/version.hpp"

namespace meltray::app {
namespace {

const CLI::Range kThreads(1, 1024);
/// Of files and folders: an empty word is what a shell makes of a variable that is not set.
const CLI::Validator kNamed(
    [](std::string& name) { return std::string(name.empty() ? "found ''; a name is needed" : ""); }, "");

/// Name of a command as it is typed: "run", "study paper".
std::string full_name(const CLI::App& command) {
  const CLI::App* parent = command.get_parent();
  const bool below = parent != nullptr && parent->get_parent() != nullptr;
  return below ? full_name(*parent) + " " + command.get_name() : command.get_name();
}

/// The command `word` of `parent`. UsageError: CLI11 only says that a command is missing; this names what
/// stands in its place.
const CLI::App& command_named(const CLI::App& parent, const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::App* c : parent.get_subcommands(nullptr)) {
    if (c->get_name() == word) return *c;
    names.push_back(c->get_name());
  }
  throw UsageError(fmt::format("found '{}' in place of a command of {}; allowed {}; nearest: {}", word,
                               full_name(parent), fmt::join(names, ", "), nearest_name(word, names)));
}

/// What to say of an option that `command` does not have.
std::string no_such_option(const CLI::App& command, const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::Option* o : command.get_options())
    for (const std::string& name : o->get_lnames()) names.push_back("--" + name);
  const std::string option = word.substr(0, word.find('='));
  return fmt::format("{}: no such option of {}; nearest: {}", option, full_name(command),
                     nearest_name(option, names));
}

/// Sub-commands fill their arguments and leave what is to be done in `command`.
class CommandLine {
 public:
  explicit CommandLine(std::function<int()>& command) : command_(command) {
    app_.require_subcommand(1);
    app_.set_version_flag("--version", "meltray " + observe::version());
    app_.footer(
        "Exit codes: 0 done, 1 a validation failed, 2 usage or case file, 3 the run failed numerically,\n"
        "4 input or output failed, 130/143 stopped by a signal (checkpoint written).");
    add_run();
    add_resume();
    add_check();
    add_validate();
    add_study();
    add_plot();
    add_compare();
    add_list();
  }

  CLI::App& app() { return app_; }

  /// Throws UsageError where a command, or one of a command such as study, is not known.
  void check_commands(int argc, char** argv) const {
    const CLI::App* at = &app_;
    for (int k = 1; k < argc && argv[k][0] != '-' && !at->get_subcommands(nullptr).empty(); ++k)
      at = &command_named(*at, argv[k]);
  }

  /// After a failed parse(): what to say of the first option that is not known; empty where all are. CLI11
  /// often complains of something else that follows from it.
  std::string unknown_option() const {
    for (const CLI::App* at = &app_;;) {
      for (const std::string& word : at->remaining())
        if (word.starts_with('-')) return no_such_option(*at, word);
      const auto below = at->get_subcommands();
      if (below.empty()) return {};
      at = below.front();
    }
  }

 private:
  void add_run() {
    auto* c = app_.add_subcommand("run", "Runs a case into a run folder");
    c->add_option("CASE", run_.case_file, "Case file (TOML)")->required();
    c->add_option("--out", run_.out, "Run folder [default: runs/<case>, then runs/<case>-002, ...]")
        ->check(kNamed);
    c->add_flag("--overwrite", run_.overwrite, "Replace a run in --out");
    add_settings(c, run_.set);
    c->add_option("--until", run_.until, "Stop at this time instead of the case's end [s]");
    c->add_option("--threads", run_.threads, "Threads [default: all cores]")->check(kThreads);
    c->add_flag("--quiet", run_.quiet, "No progress");
    c->callback([this] {
      if (run_.overwrite && !run_.out) throw UsageError("--overwrite: has no effect without --out");
      command_ = [this] { return run(run_); };
    });
  }

  void add_resume() {
    auto* c = app_.add_subcommand("resume", "Goes on with a stopped run, or forks it with other settings");
    c->add_option("RUNDIR", resume_.run_folder, "Run folder")->required();
    c->add_option("--until", resume_.until, "Go on to this time [s]");
    add_settings(c, resume_.set);
    c->add_option("--out", resume_.out, "New folder of a fork")->check(kNamed);
    c->add_option("--threads", resume_.threads, "Threads [default: all cores]")->check(kThreads);
    c->add_flag("--quiet", resume_.quiet, "No progress");
    c->callback([this] { command_ = [this] { return resume(resume_); }; });
  }

  void add_check() {
    auto* c = app_.add_subcommand("check", "Checks a case and tells what it would do, without running it");
    c->add_option("CASE", run_.case_file, "Case file (TOML)")->required();
    add_settings(c, run_.set);
    c->callback([this] { command_ = [this] { return check(run_.case_file, run_.set); }; });
  }

  void add_validate() {
    auto* c = app_.add_subcommand("validate", "Runs validation cases against their references");
    c->add_option("ID", validate_.ids, "Validation cases");
    c->add_flag("--all", validate_.all, "Tiers 1 and 2");
    c->add_option("--tier", validate_.tier, "1: analytic, 2: flow benchmarks, 3: welds against experiment");
    c->add_flag("--list", validate_.list, "Only list them");
    c->add_flag("--small", validate_.small, "The twins that take seconds");
    c->add_option("--json", validate_.json, "Write the results to this file")->check(kNamed);
    c->add_flag("--commands", validate_.commands, "Tier 3: only print the commands of what is still to run");
    c->add_flag("--finished", validate_.finished, "Tier 3: compare what has run, start nothing");
    c->add_option("--out", validate_.out,
                  "Tier 3: folder of the runs, which are kept [default: runs/validation]")
        ->check(kNamed);
    c->add_option("--threads", validate_.threads, "Tier 3: threads [default: all cores]")->check(kThreads);
    c->callback([this] { command_ = [this] { return validate(validate_); }; });
  }

  /// One sub-command a kind of study.
  void add_study() {
    auto* c =
        app_.add_subcommand("study", "Error against work, splitting and stability of the time integration");
    c->require_subcommand(1);
    const auto add = [&](const char* kind, const char* text, const char* scenes) {
      auto* k = c->add_subcommand(kind, text);
      k->add_option("ID", study_.what, scenes)->required();
      k->add_option("--json", study_.json, "Write the results to this file as well")->check(kNamed);
      k->add_option("--out", study_.out, "Folder of the results [default: runs/studies/<id>]")->check(kNamed);
      k->add_flag("--small", study_.small, "The twin that takes seconds");
      k->add_option("--threads", study_.threads, "Threads [default: all cores]")->check(kThreads);
      k->callback([this, kind] {
        study_.kind = kind;
        command_ = [this] { return study(study_); };
      });
      return k;
    };
    add("work-precision", "Error against evaluations and time over methods and steps",
        "Scene of the studies, or a case file");
    add("splitting", "Order, largest stable step and cost of each assignment of terms",
        "Scene of the studies, or a case file");
    add("stability", "Where a scene is stable, degraded or fails, over step, resolution and a parameter",
        "Scene of the studies, or a case file")
        ->add_option("--parameter", study_.parameter,
                     "What is varied [default: the first that the scene has]");
    add_paper(c);
  }

  void add_paper(CLI::App* study_command) {
    auto* c =
        study_command->add_subcommand("paper", "The paper's welds: runs what is missing, table and figures");
    c->add_option("--metals", paper_.metals, "iron, aluminium")
        ->delimiter(',')
        ->check(CLI::IsMember({"iron", "aluminium"}));
    c->add_option("--frequencies", paper_.frequencies, "100, 250, 500 [Hz]")
        ->delimiter(',')
        ->check(CLI::IsMember({100, 250, 500}));
    c->add_option("--models", paper_.models, "Rows of Table 1")
        ->delimiter(',')
        ->check(CLI::IsMember({"isph", "wcsph", "wcsph_reduced", "wcsph_reduced_interface"}));
    c->add_option("--seeds", paper_.seeds, "1: the lattice; n: n disturbed lattices")
        ->check(CLI::Range(1, 1000));
    c->add_option("--until", paper_.until, "End of every run [s]")->check(CLI::Range(1e-12, 1e3));
    add_settings(c, paper_.set);
    c->add_option("--out", paper_.out,
                  "Folder of runs and results [default: runs/paper; with --set another one has to be given]")
        ->check(kNamed);
    c->add_flag("--list", paper_.list, "Only print the commands that are still to run, for a batch system");
    c->add_option("--threads", paper_.threads, "Threads [default: all cores]")->check(kThreads);
    c->callback([this] { command_ = [this] { return study_paper(paper_); }; });
  }

  void add_plot() {
    auto* c = app_.add_subcommand("plot", "Draws the pictures of one run or several, finished or not");
    c->add_option("RUNDIR", folders_, "Run folders")->required();
    c->callback([this] { command_ = [this] { return plot(folders_); }; });
  }

  void add_compare() {
    auto* c = app_.add_subcommand("compare", "Compares simulated with measured depth ratios");
    c->add_option("RUNDIR", compare_.run_folders, "Run folders")->required();
    c->add_option("--measured", compare_.measured, "CSV of measurements")->required();
    c->add_option("--json", compare_.json, "Write the results to this file as well")->check(kNamed);
    c->callback([this] { command_ = [this] { return compare(compare_); }; });
  }

  void add_list() {
    auto* c = app_.add_subcommand("list", "Lists cases, materials, terms, methods, kernels or keys");
    c->add_option("WHAT", what_, "cases, materials, terms, methods, kernels or keys");
    c->callback([this] { command_ = [this] { return list(what_); }; });
  }

  /// One setting after each --set; never takes the arguments behind it.
  static void add_settings(CLI::App* c, std::vector<std::string>& set) {
    c->add_option("--set", set, "Overrides a key of the case: section.key=value (repeatable)")
        ->type_name("KEY=VALUE")
        ->expected(1)
        ->take_all();
  }

  std::function<int()>& command_;
  CLI::App app_{"Meltray: laser beam welding with SPH", "meltray"};
  RunArguments run_;
  ResumeArguments resume_;
  ValidateArguments validate_;
  StudyArguments study_;
  PaperArguments paper_;
  std::vector<std::filesystem::path> folders_;
  CompareArguments compare_;
  std::string what_;
};

int complain(int code, std::string_view text) {
  std::fflush(stdout);
  // fmt::print() would throw where standard error cannot be written.
  std::fputs(fmt::format("meltray: {}\n", text).c_str(), stderr);
  return code;
}

/// `code`, unless it is a success whose output could not be written.
int with_output(int code) {
  // An earlier flush that failed has dropped its text: the last one then succeeds.
  const bool lost = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
  return lost && code == kExitOk ? complain(kExitIo, "standard output: not all could be written") : code;
}

/// Answers a command line that asks for help or is not understood.
int answer(CommandLine& line, const CLI::ParseError& e) {
  const bool asked = e.get_exit_code() == 0;
  if (const std::string text = line.unknown_option(); !asked && !text.empty())
    return complain(kExitUsage, text);
  line.app().exit(e);
  return with_output(asked ? kExitOk : kExitUsage);
}

}  // namespace

int run_command_line(int argc, char** argv) {
  std::function<int()> command;
  CommandLine line(command);
  try {
    line.check_commands(argc, argv);
    line.app().parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return answer(line, e);
  } catch (const UsageError& e) {
    return complain(kExitUsage, e.what());
  }
  try {
    return with_output(command());
  } catch (const UsageError& e) {
    return complain(kExitUsage, e.what());
  } catch (const NumericalFailure& e) {
    return complain(kExitNumerical, e.what());
  } catch (const IoError& e) {
    return complain(kExitIo, e.what());
  } catch (const std::filesystem::filesystem_error& e) {
    return complain(kExitIo, e.what());
  } catch (const std::system_error& e) {  // of fmt::print()
    return complain(kExitIo, fmt::format("standard output: cannot write: {}", e.code().message()));
  } catch (const std::bad_alloc&) {
    return complain(kExitNumerical, "out of memory: fewer or coarser particles are needed");
  } catch (const std::exception& e) {
    return complain(kExitNumerical, fmt::format("internal error: {}", e.what()));
  }
}

}  // namespace meltray::app
