# Builds the Java types for lcm-spy: cmake -DLCM_GEN=… -DSOURCES=a.lcm|b.lcm -DWORK=folder -DJAR=nbs_msgs.jar -P build_spy_jar.cmake
# The tools are looked for when it runs, so that a JDK installed after the configuration is found.
find_program(JAVAC javac)
find_program(JAR_TOOL jar)
find_file(LCM_JAR lcm.jar PATHS /usr/share/java /usr/local/share/java)
if(NOT JAVAC OR NOT JAR_TOOL OR NOT LCM_JAR)
  message(FATAL_ERROR "lcm-spy's types need a JDK and LCM's Java library: install default-jdk-headless and liblcm-java")
endif()

string(REPLACE "|" ";" SOURCES "${SOURCES}")
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK}/classes)
execute_process(COMMAND ${LCM_GEN} -j --jpath ${WORK}/java ${SOURCES} COMMAND_ERROR_IS_FATAL ANY)
file(GLOB java_files ${WORK}/java/nbs_msgs/*.java)
execute_process(
  COMMAND ${JAVAC} --release 8 -Xlint:-options -nowarn -cp ${LCM_JAR} -d ${WORK}/classes ${java_files}
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${JAR_TOOL} cf ${JAR} -C ${WORK}/classes . COMMAND_ERROR_IS_FATAL ANY)
