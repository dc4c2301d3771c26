// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// The commands of the program; each returns an exit code of the contract or throws one of core/errors.hpp.
namespace meltray::app {

struct RunArguments {
  std::filesystem::path case_file;
  std::optional<std::filesystem::path> out;
  bool overwrite = false;
  std::vector<std::string> set;
  std::optional<double> until;
  int threads = 0;  ///< 0: all cores
  bool quiet = false;
};

struct ResumeArguments {
  std::filesystem::path run_folder;
  std::optional<double> until;
  std::vector<std::string> set;
  std::optional<std::filesystem::path> out;
  int threads = 0;
  bool quiet = false;
};

struct ValidateArguments {
  std::vector<std::string> ids;
  std::optional<int> tier;                        ///< 1 analytic, 2 flow benchmarks, 3 welds
  bool all = false, list = false, small = false;  ///< small: the seconds-long twins that ./dev test runs
  bool commands = false;  ///< print the commands of the welds that are still to run, and nothing else
  bool finished = false;  ///< compare the welds that have run; start none
  std::filesystem::path out = "runs/validation";  ///< of the welds of tier 3, which are kept there
  std::optional<std::filesystem::path> json;
  int threads = 0;  ///< of the welds of tier 3
};

struct StudyArguments {
  std::string kind;       ///< "work-precision", "splitting" or "stability"
  std::string what;       ///< scene of the studies; for "stability" a case file as well
  std::string parameter;  ///< of "stability"; empty: the first that the scene has
  std::optional<std::filesystem::path>
      out;  ///< of results and of the runs that are kept; default runs/studies/<id>
  std::optional<std::filesystem::path> json;
  bool small = false;
  int threads = 0;
};

/// The paper's matrix of welds, or a part of it.
struct PaperArguments {
  std::vector<std::string> metals{"iron", "aluminium"};
  std::vector<int> frequencies{100, 250, 500};  ///< [Hz]
  std::vector<std::string> models{"isph", "wcsph_reduced", "wcsph_reduced_interface"};
  int seeds = 1;                 ///< 1: the undisturbed lattice; n > 1: n disturbed ones
  std::optional<double> until;   ///< [s]; default: the end of each case
  std::vector<std::string> set;  ///< for every weld, over what its case and row of Table 1 say
  std::filesystem::path out = "runs/paper";
  bool list = false;  ///< print the commands that are still to run
  int threads = 0;
};

struct CompareArguments {
  std::vector<std::filesystem::path> run_folders;
  std::filesystem::path measured;  ///< CSV
  std::optional<std::filesystem::path> json;
};

int run(const RunArguments& arguments);
int resume(const ResumeArguments& arguments);
int check(const std::filesystem::path& case_file, const std::vector<std::string>& set);
int list(const std::string& what);  ///< "", "cases", "materials", "terms", "methods" or "kernels"
int validate(const ValidateArguments& arguments);
int study(const StudyArguments& arguments);
/// Runs what is not done yet; writes paper.csv, ratios.txt and the figures to `out`.
int study_paper(const PaperArguments& arguments);
int plot(const std::vector<std::filesystem::path>& run_folders);
int compare(const CompareArguments& arguments);

}  // namespace meltray::app
