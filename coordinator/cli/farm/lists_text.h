#pragma once

// Formats jobs and workers as tables, and as one JSON object per line. Pure functions.

#include <string>
#include <vector>

#include "coordinator/cli/progress/progress.h"
#include "proto/farm.pb.h"

namespace bandsaw::coordinator {

/// Without the guides of clean images that are done; a last line states their number.
std::vector<std::string> jobs_table(const std::vector<Progress>& jobs);
std::vector<std::string> jobs_json(const std::vector<Progress>& jobs);
std::vector<std::string> why_json(JobId job, const std::vector<std::string>& reasons);
std::string log_json(const std::string& worker, const std::vector<std::string>& lines);
std::vector<std::string> workers_table(const farm::ListWorkersReply& reply);
std::vector<std::string> workers_json(const farm::ListWorkersReply& reply);

/// Formats rows of cells as a table whose columns are as wide as their widest cell, two spaces
/// apart. The first row is the heading.
std::vector<std::string> table(const std::vector<std::vector<std::string>>& rows);

}  // namespace bandsaw::coordinator
