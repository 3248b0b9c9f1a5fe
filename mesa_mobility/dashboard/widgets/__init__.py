"""Fields, tabs, headings and notes that the dashboard's page is built of."""
