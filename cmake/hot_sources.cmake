# What bench/ratios measures, by folder: these sources are compiled each alone at -O3 in what users run, because the
# compiler bounds inlining for each source that it sees: joined, a ring of 64 stations took a quarter more time.
# Everything else is joined and optimized less: that is a third of the time of the release build.
set(hot_sources
  "harness/(kernel|line|trace|segment|traffic)/"
  "harness/fault/(rule|rule_channel|condition|telegram_fields|channel_chain|scripted_channel|arrivals)\\."
  "harness/measure/(distribution|edge_skew)\\."
  "harness/iut/(peer|server|message|plugin|attached_case|[a-z_]*device)\\."
  "protocols/interbus/(ring|slave|latching_slave|master|master_cycles|master_verdict|cycle_frame|cycle_fields)\\."
  "protocols/interbus/(station_timing|telegram_front)\\."
  "protocols/valve_bus/(node|attached_node|attached_line|codec|frame|transmitter)\\."
  "protocols/bandwidth/window_(load|traffic)\\."
  "protocols/fieldbus_dll/(ff_link|ff_las|ff_station|ff_dlpdu|line_end)\\."
  "emc/residual/(dual_weights|register_cycles|residual_simulation)\\."
  "emc/(burst_channel|effective_time|generator|pulse|sampled_impact|exponential|random_flips|coupling|framing)\\.")

# fieldproof_compile_hot_sources(sources...): those of them that are named above.
function(fieldproof_compile_hot_sources)
  foreach(source IN LISTS ARGN)
    file(RELATIVE_PATH path "${CMAKE_SOURCE_DIR}" "${source}")
    foreach(pattern IN LISTS hot_sources)
      if(path MATCHES "^${pattern}")
        set_source_files_properties("${source}" PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON COMPILE_OPTIONS -O3)
      endif()
    endforeach()
  endforeach()
endfunction()
