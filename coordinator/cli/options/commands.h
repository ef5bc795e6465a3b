#pragma once

// The functions run() execute the commands: one for each type of options in the variant `Command`
// (cli/options/options.h). Each prints its results and returns the exit status. main() calls them.

#include "coordinator/cli/base/console.h"
#include "coordinator/cli/base/exit_code.h"
#include "coordinator/cli/base/interrupts.h"
#include "coordinator/cli/options/options.h"

namespace bandsaw::coordinator {

/// The output and the signals of this process, which commands use.
struct Process {
  const Console& console;
  Interrupts& interrupts;
};

ExitCode run(const ServeOptions& options, Process& process);
ExitCode run(const SubmitOptions& options, Process& process);
ExitCode run(const WatchOptions& options, Process& process);
ExitCode run(const JobsOptions& options, Process& process);
ExitCode run(const WorkersOptions& options, Process& process);
ExitCode run(const CancelOptions& options, Process& process);
ExitCode run(const PauseOptions& options, Process& process);
ExitCode run(const ResumeOptions& options, Process& process);
ExitCode run(const PriorityOptions& options, Process& process);
ExitCode run(const WhyOptions& options, Process& process);
ExitCode run(const MissingOptions& options, Process& process);
ExitCode run(const RetryOptions& options, Process& process);
ExitCode run(const LogsOptions& options, Process& process);
ExitCode run(const QuarantineOptions& options, Process& process);
ExitCode run(const DoctorOptions& options, Process& process);
ExitCode run(const RotateOptions& options, Process& process);
ExitCode run(const LinkOptions& options, Process& process);
ExitCode run(const InviteOptions& options, Process& process);
ExitCode run(const DismissOptions& options, Process& process);
ExitCode run(const RenderOptions& options, Process& process);
ExitCode run(const InfoOptions& options, Process& process);
ExitCode run(const ImportOptions& options, Process& process);
ExitCode run(const StitchOptions& options, Process& process);
ExitCode run(const CompareOptions& options, Process& process);
ExitCode run(const StudyOptions& options, Process& process);
ExitCode run(const ShowText& options, Process& process);

}  // namespace bandsaw::coordinator
