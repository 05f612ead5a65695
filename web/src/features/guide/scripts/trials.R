# Reads the table of the released trials into a data frame. Needs only R.
server <- Sys.getenv("TRACTUS_URL")
token <- Sys.getenv("TRACTUS_TOKEN")
answer <- url(paste0(server, "/api/v1/export/trials.csv"),
              headers = c(Authorization = paste("Bearer", token)))
trials <- read.csv(answer)
print(nrow(trials))
