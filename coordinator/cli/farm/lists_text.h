#pragma once

// Formats the lists that commands print as tables for people, and as one JSON object per line for
// programs. The lists are jobs, workers, reasons why a job waits, and logs. The functions are pure;
// each string is a line without a line end.

#include <string>
#include <vector>

#include "coordinator/cli/progress/progress.h"
#include "proto/farm.pb.h"

namespace bandsaw::coordinator {

/// Lists all jobs except finished guides (jobs that only render what the denoiser needs). If there
/// are finished guides, the last line states their number.
std::vector<std::string> jobs_table(const std::vector<Progress>& jobs);
/// Lists all jobs.
std::vector<std::string> jobs_json(const std::vector<Progress>& jobs);
/// Lists the reasons why the job waits.
std::vector<std::string> why_json(JobId job, const std::vector<std::string>& reasons);
std::string log_json(const std::string& worker, const std::vector<std::string>& lines);
std::vector<std::string> workers_table(const farm::ListWorkersReply& reply);
std::vector<std::string> workers_json(const farm::ListWorkersReply& reply);

/// Formats rows of cells as a table whose columns are as wide as their widest cell, two spaces
/// apart. The first row is the heading.
std::vector<std::string> table(const std::vector<std::vector<std::string>>& rows);

}  // namespace bandsaw::coordinator
