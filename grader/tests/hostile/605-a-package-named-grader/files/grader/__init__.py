"""Not the real one."""

print("TRA" "CE of another grader")
